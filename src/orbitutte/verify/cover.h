// SPDX-License-Identifier: MIT
// The |G|-fold cover of an embedded mesh, told by one vertex and one edge of every orbit.
#pragma once

#include <vector>

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {

/// Joins, for every h in G, copy h of vertex i to copy h g of vertex j. Where that names an edge of the cover
/// several times, its weight is as many times `weight`.
struct CoverEdge {
  int i, j;       ///< vertices of the uncut mesh
  int g;          ///< an element of the group
  double weight;  ///< w_ij of the energy
  double length;  ///< the arc length between positions(i) and g positions(j), radians
};

/// Copy h of vertex i lies at h positions(i); copies h and h s are the same where s is in the stabilizer of
/// i.
struct Cover {
  Points positions;                           ///< n x 3, unit
  std::vector<std::vector<int>> stabilizers;  ///< n: generators, elements of the group; none for most
  Eigen::VectorXd area;                       ///< n: a third of the unsigned areas of the vertex's faces
  std::vector<CoverEdge> edges;
};

/// The edges are those of the surface, or those of the intrinsic triangulation that has the weights, with its
/// faces; the group is that of the seams. The embedding must have passed the
/// certificate's checks cut_mesh, seam_transforms, seam_gluing and group_order. Throws MeshError where the
/// seams do not join the copies of a vertex, ArgumentError where a transform is not in the group.
Cover cover_of(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
               const SymmetryGroup& group);

}  // namespace orbitutte
