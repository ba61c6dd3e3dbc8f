// SPDX-License-Identifier: MIT
// Decomposes a symmetry group's actions on vector spaces into irreducible ones.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {

/// An orthogonal action of a group: matrices[g] matrices[h] = matrices[g h].
struct Representation {
  int dimension = 1;
  /// How often the representation occurs in the space of all functions on the group.
  int multiplicity = 1;
  /// |G| matrices, dimension x dimension, in the order of the group's elements.
  std::vector<Eigen::MatrixXd> matrices;
};

/// The irreducible representations of a group over the real numbers, one of each kind, by ascending
/// dimension. The sum of multiplicity * dimension is |G|. They are the eigenspaces of a random symmetric
/// matrix that commutes with all translations of functions on the group (Dixon 1970). Time O(|G|^3). Throws
/// std::logic_error if the result is not a decomposition.
std::vector<Representation> irreducible_representations(const SymmetryGroup& group);

/// How often a representation occurs in the group's own action on space: the mean over g of
/// trace(matrices[g]) trace(g).
int occurrences_in_space(const Representation& representation, const SymmetryGroup& group);

/// An orthonormal basis (dimension x k) of the vectors that all these elements fix.
Eigen::MatrixXd fixed_vectors(const Representation& representation, const std::vector<int>& elements);

}  // namespace orbitutte
