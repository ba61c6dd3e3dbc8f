// SPDX-License-Identifier: MIT
// The two conditions under which theorem 2 proves that a discrete harmonic map is an embedding.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/names.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/verify/certificate.h"
#include "orbitutte/verify/inertia.h"

namespace orbitutte {

/// How the eigenvalues are counted.
struct Theorem2Options {
  InertiaMethod method = available_inertia_methods().front();
  /// Representations of larger groups take too long: |G|^3.
  int max_group_order = 480;
};

/// The part of W that one irreducible representation of G carries.
struct RepresentationInertia {
  int dimension = 1;
  /// How often the eigenvalues of this part occur in the cover's spectrum.
  int multiplicity = 1;
  long unknowns = 0;
  /// The number of eigenvalues below -shift.
  long negative = 0;
  /// The number of eigenvalues between -shift and shift.
  long kernel = 0;
  /// The number of zero eigenvalues that theory expects: those of x, y and z.
  int coordinates = 0;
  double shift = 0;
};

/// The findings about the two conditions.
struct Theorem2 {
  enum class Status { measured, inconclusive, not_run };
  Status status = Status::not_run;
  /// Why the check was not run or is inconclusive.
  std::string detail;
  InertiaMethod method = InertiaMethod::eigen;
  /// Radians.
  double max_edge_length = 0;
  /// The number of negative eigenvalues of W on the whole cover, with multiplicity.
  long negative = 0;
  /// The number of zero eigenvalues.
  long kernel = 0;
  /// Three eigenvalues lie at most this far from zero.
  double kernel_residual = 0;
  std::vector<RepresentationInertia> representations;

  /// theorem2_edges: the longest edge is below pi/2. If the eigenvalues were measured, also theorem2_inertia:
  /// exactly one of them is negative; and theorem2_kernel: the kernel has dimension three.
  std::vector<Check> checks() const;
  /// Measured, and all checks passed.
  bool holds() const;
};

/// Its names.
template <>
struct NameTable<Theorem2::Status> {
  static constexpr NamedValue<Theorem2::Status> rows[] = {{Theorem2::Status::measured, "measured"},
                                                          {Theorem2::Status::inconclusive, "inconclusive"},
                                                          {Theorem2::Status::not_run, "not run"}};
};

/// Why the theorem does not speak of maps to the target, which has no finite group; empty if it does.
std::string reason_without_theorem2(const Target& target);

/// Measures the longest edge, and the inertia of the matrix W of equation (11) on the |G|-fold cover,
///
///     W_ij = -w_ij d_ij / sin d_ij  (i != j),    W_ii = sum over j of w_ij d_ij cot d_ij,
///
/// where d_ij is the length of edge ij. The coordinates of a discrete harmonic map lie in the kernel of W.
/// The cover is never built: W splits over the irreducible representations rho of G into matrices on vectors
/// x_i, one in the space that rho fixes under the stabilizer of vertex i, with blocks -w d/sin d rho(g) for
/// an edge from i to copy g of j.
///
/// The eigenvalues are those of W x = lambda D x, D_i = E / (2 A) * (the vertex's area) + 1e-12 * sum over j
/// of w d/sin d, where A is the area of the tile. They are close to those of -(Laplacian + 2) on the sphere,
/// which are -2, then 0 three times, then 4. The residual of the coordinates bounds how far the eigenvalues
/// of the kernel can be from 0 (Kahan: Parlett, "The symmetric eigenvalue problem", theorem 11.5.1). Each
/// part is counted at -s and s for s = 1/2, 1/8, ... until no more eigenvalues lie between them than
/// coordinates belong there. s stays at least ten times the residual, and at least 1e-6; if the residual
/// leaves no such s, the check is inconclusive.
///
/// The check is not run if the theorem does not speak of the target (reason_without_theorem2), if the group
/// is too large, if the factorisation breaks down or if memory runs out. Otherwise the embedding must meet
/// the conditions of cover_of; throws as cover_of does.
Theorem2 check_theorem2(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                        const Theorem2Options& options = {});

/// The number of eigenvalues of W x = lambda D x, as above, that the whole cover has below `shift`, with
/// multiplicity. Throws ArgumentError if the group is infinite, InertiaNotFound, and as cover_of does.
long cover_eigenvalues_below(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                             double shift, const Theorem2Options& options = {});

}  // namespace orbitutte
