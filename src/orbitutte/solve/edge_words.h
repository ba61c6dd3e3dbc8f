// SPDX-License-Identifier: MIT
// The gluing of the edges of a surface that is cut along a tree, as products of rotations about its cones and
// of reflections in its mirrors: what it is for any places of the marks.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/solve/dirichlet_energy.h"

namespace orbitutte {

/// A product of generators g_1 .. g_k of a surface's gluings (Moduli) and their inverses: i + 1 stands for
/// g_(i + 1), its negative for the inverse; the first letter is the leftmost factor.
using GluingWord = std::vector<int>;

/// The edges of the energy, each with the word that is applied to its second end.
///
/// A mirror is a seam whose banks are the same vertices: on two copies of a disk, glued along its boundary,
/// an edge from p to g q has a mirror image. If M and N are the reflections in the mirrors of its ends, in
/// their frames, or the identity where an end lies on none, that is the edge from p to (M g N) q. Both are
/// edges here, each with half the weight, unless both words are the same. For vertices on their mirrors the
/// energy is that of the disk; where mirrors move away, it draws their vertices after them.
struct EdgeWords {
  /// As GluedEdges::edges, with an index into words; 0 is the empty word. The mirror images follow the
  /// edges.
  std::vector<GluedEdge> edges;

  /// Distinct, and reduced: no letter stands beside its inverse.
  std::vector<GluingWord> words;

  /// The edges that have a mirror image, in the order of these.
  std::vector<int> mirrored;

  /// The weights of all these edges, from those of the edges themselves.
  Eigen::VectorXd weights(const Eigen::VectorXd& w) const;
};

/// The words of the surface's edges, or of the edges of a triangulation of it if that is not null. The
/// letters are the generators of the marks as the boundary of the cut mesh meets them (cut.arrangement),
/// counterclockwise, about the copies that it meets first. The surface is a sphere or a disk that was cut
/// along a tree (cut_along_tree).
EdgeWords edge_words(const Surface& surface, const IntrinsicTriangulation* triangulation, const CutMesh& cut);

}  // namespace orbitutte
