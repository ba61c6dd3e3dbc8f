// SPDX-License-Identifier: MIT
// The two conditions under which theorem 2 proves that a discrete harmonic map is an embedding.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/verify/certificate.h"
#include "orbitutte/verify/inertia.h"

namespace orbitutte {

/// How the eigenvalues are counted.
struct Theorem2Options {
  InertiaMethod method = available_inertia_methods().front();
  int max_group_order = 480;  ///< the representations of larger groups take too long: |G|^3
};

/// The part of W that one irreducible representation of G carries.
struct RepresentationInertia {
  int dimension = 1;
  int multiplicity = 1;  ///< the cover's spectrum holds that of this part so many times
  long unknowns = 0;
  long negative = 0;    ///< eigenvalues below -shift
  long kernel = 0;      ///< eigenvalues between -shift and shift
  int coordinates = 0;  ///< how many of them theory expects: those of x, y and z
  double shift = 0;
};

/// What was found of the two conditions.
struct Theorem2 {
  enum class Status { measured, inconclusive, not_run };
  Status status = Status::not_run;
  std::string detail;  ///< why it was not run or is inconclusive
  InertiaMethod method = InertiaMethod::eigen;
  double max_edge_length = 0;  ///< radians
  long negative = 0;           ///< negative eigenvalues of W on the whole cover, with multiplicity
  long kernel = 0;             ///< and zero eigenvalues
  double kernel_residual = 0;  ///< three eigenvalues lie so near to zero, at most
  std::vector<RepresentationInertia> representations;

  /// theorem2_edges: the longest edge is below pi/2. Where it was measured: theorem2_inertia, one negative
  /// eigenvalue; theorem2_kernel, of dimension three.
  std::vector<Check> checks() const;
  bool holds() const;  ///< measured, and all checks passed
};

/// "measured", "inconclusive" or "not run".
std::string name(Theorem2::Status status);

/// The longest edge, and the inertia of the matrix W of equation (11) on the |G|-fold cover,
///
///     W_ij = -w_ij d_ij / sin d_ij  (i != j),    W_ii = sum over j of w_ij d_ij cot d_ij,    d_ij the length
///     of edge ij,
///
/// in whose kernel the coordinates of a discrete harmonic map lie. The cover is never built: W splits over
/// the irreducible representations rho of G into matrices on vectors x_i of the spaces that rho fixes under
/// the stabilizer of vertex i, with blocks -w d/sin d rho(g) for an edge from i to copy g of j.
///
/// Eigenvalues are those of W x = lambda D x, D_i = E / (2 A) * (the vertex's area) + 1e-12 * sum over j of
/// w d/sin d, with A the area of the tile: about those of -(Laplacian + 2) on the sphere, which begin with
/// -2, 0, 0, 0,
/// 4. The residual of the coordinates bounds how far the kernel's can be from 0 (Kahan: Parlett, "The
/// symmetric eigenvalue problem", theorem 11.5.1). Each part is counted at -s and s for s = 1/2, 1/8, ...
/// until as many eigenvalues lie between as coordinates belong there; s stays ten times above the residual,
/// and above 1e-6. Inconclusive where the residual leaves no such s.
///
/// The embedding must be as cover_of wants it. Not run: a group too large, a factorisation that broke down,
/// memory that ran out. Throws as cover_of does.
Theorem2 check_theorem2(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                        const Theorem2Options& options = {});

/// How many eigenvalues of W x = lambda D x, as above, the whole cover has below `shift`, with multiplicity.
/// Throws InertiaNotFound, and as cover_of does.
long cover_eigenvalues_below(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                             double shift, const Theorem2Options& options = {});

}  // namespace orbitutte
