// SPDX-License-Identifier: MIT
// The ways in which a symmetry group acts on vector spaces, taken apart.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {

/// An orthogonal action of a group: matrices[g] matrices[h] = matrices[g h].
struct Representation {
  int dimension = 1;
  int multiplicity = 1;  ///< how often it occurs in the space of all functions on the group
  std::vector<Eigen::MatrixXd>
      matrices;  ///< |G|, dimension x dimension, in the order of the group's elements
};

/// The irreducible representations of a group over the real numbers, one of each kind, those of least
/// dimension first; the sum of multiplicity * dimension is |G|. They are the eigenspaces of a random
/// symmetric matrix that commutes with all translations of functions on the group (Dixon 1970). Time
/// O(|G|^3). Throws std::logic_error where what comes out is no decomposition.
std::vector<Representation> irreducible_representations(const SymmetryGroup& group);

/// How often an irreducible representation and the group's own action on space have a vector in common: the
/// mean over g of trace(matrices[g]) trace(g).
int occurrences_in_space(const Representation& representation, const SymmetryGroup& group);

/// An orthonormal basis (dimension x k) of the vectors that all the elements leave as they are.
Eigen::MatrixXd fixed_vectors(const Representation& representation, const std::vector<int>& elements);

}  // namespace orbitutte
