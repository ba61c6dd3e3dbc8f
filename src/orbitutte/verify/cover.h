// SPDX-License-Identifier: MIT
// The |G|-fold cover of an embedded mesh, represented by one vertex and one edge of every orbit.
#pragma once

#include <vector>

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {

/// Joins copy h of vertex i to copy h g of vertex j, for every h in G. If it names an edge of the cover k
/// times, that edge has k times the weight `weight`.
struct CoverEdge {
  /// Vertices of the uncut mesh.
  int i, j;
  /// An element of the group.
  int g;
  /// w_ij of the energy.
  double weight;
  /// The arc length between positions(i) and g positions(j), radians.
  double length;
};

/// Copy h of vertex i lies at h positions(i). Copies h and h s are the same if s is in the stabilizer of i.
struct Cover {
  /// n x 3, unit.
  Points positions;
  /// n: elements of the group that generate the vertex's stabilizer. Most lists are empty.
  std::vector<std::vector<int>> stabilizers;
  /// n: a third of the unsigned areas of the vertex's faces.
  Eigen::VectorXd area;
  std::vector<CoverEdge> edges;
};

/// The edges are those of the surface, or those of the intrinsic triangulation to which the weights belong,
/// with its faces; the group is that of the seams. The embedding must have passed the certificate's checks
/// cut_mesh, seam_transforms, seam_gluing and group_order. Throws MeshError if the seams do not join the
/// copies of a vertex, and ArgumentError if a transform is not in the group.
Cover cover_of(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
               const SymmetryGroup& group);

}  // namespace orbitutte
