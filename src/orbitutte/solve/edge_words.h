// SPDX-License-Identifier: MIT
// The gluing of the edges of a surface that is cut along a tree, as products of rotations about its cones:
// what it is for any places of the cones.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/solve/dirichlet_energy.h"

namespace orbitutte {

/// A product of rotations R_1 .. R_k and their inverses: i + 1 stands for R_(i + 1), its negative for the
/// inverse; the first letter is the leftmost factor.
using RotationWord = std::vector<int>;

/// The product in letters of any group.
template <typename Element>
Element product_of_word(const RotationWord& word, const std::vector<Element>& rotations, Element identity) {
  for (const int letter : word)
    identity = identity * (letter > 0 ? rotations[letter - 1] : rotations[-letter - 1].inverse());
  return identity;
}

/// The edges of the energy, each with the word that is applied to its second end.
struct EdgeWords {
  /// As GluedEdges::edges, with an index into words; 0 is the empty word.
  std::vector<GluedEdge> edges;

  /// Distinct, and reduced: no letter stands beside its inverse.
  std::vector<RotationWord> words;
};

/// The words of the surface's edges, or of the edges of a triangulation of it if that is not null. R_i is the
/// rotation about the i-th cone that the boundary of the cut mesh meets (cut.arrangement), counterclockwise,
/// about the copy that it meets first. The surface is a sphere that was cut along a tree (cut_along_tree).
EdgeWords edge_words(const Surface& surface, const IntrinsicTriangulation* triangulation, const CutMesh& cut);

}  // namespace orbitutte
