// SPDX-License-Identifier: MIT
// Places where two faces of a mesh touch more than once. Without the two vertices of such a place the mesh
// falls apart.
#pragma once

#include <vector>

#include "orbitutte/mesh/polygon_topology.h"

namespace orbitutte {

/// Two faces that share two vertices, which are not joined by edges of both faces. The two vertices separate
/// the mesh.
struct DoubleContact {
  int face = -1, other = -1;
  int vertex = -1, second = -1;
};

/// One double contact for every two vertices and every two faces that have any. N. Chiba, T. Nishizeki,
/// "Arboricity and subgraph listing algorithms" (SIAM J. Comput. 14, 1985): the cycles of length four in the
/// graph of vertices and faces, which is planar, in O(c log c).
std::vector<DoubleContact> double_contacts(const PolygonTopology& surface, int vertex_count);

}  // namespace orbitutte
