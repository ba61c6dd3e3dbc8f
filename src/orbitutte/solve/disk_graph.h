// SPDX-License-Identifier: MIT
// The glued edges laid out in the cut disk, as both linear systems see them. Private to solve/.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/solve/dirichlet_energy.h"

namespace orbitutte {

/// A graph whose nodes are images of vertices, transforms[transform_of] * position(vertex). Every edge whose
/// gluing is not the identity has an end on a bank: a vertex of the cut's boundary, or one that is added
/// where an edge crosses the cut between two others. Neighbours of cones are added, too. So the vertices
/// inside are nodes once, in place, and their three coordinates do not couple.
struct DiskGraph {
  /// Of every node; the first n nodes are the vertices in place.
  std::vector<int> vertex;
  /// Of every node: an index into transforms.
  std::vector<int> transform_of;
  /// Distinct; the first is the identity.
  std::vector<Isometry> transforms;
  /// Of every glued edge: the nodes of one of its images.
  std::vector<std::array<int, 2>> ends;
  /// The nodes of bank vertices that may move, vertex by vertex.
  std::vector<int> banks;
  /// n: does the vertex move, on no bank?
  std::vector<char> inside;
  /// n: is the vertex on the boundary of the cut, or held?
  std::vector<char> given;

  int node_count() const { return static_cast<int>(vertex.size()); }
  const Isometry& transform(int node) const { return transforms[transform_of[node]]; }

  /// Is the node's place in the start unknown: inside, or on a bank that the cut's boundary does not name?
  bool unknown_at_start(int node) const { return !given[vertex[node]]; }
};

/// The two vertices of every edge.
std::vector<std::array<int, 2>> ends(const GluedEdges& glued);

DiskGraph disk_graph(const CutMesh& cut, const GluedEdges& glued, const BoundaryConditions& boundary);

}  // namespace orbitutte
