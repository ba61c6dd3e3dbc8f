// SPDX-License-Identifier: MIT
// Half-edges, undirected edges and neighbours of a manifold triangle mesh. If triangles make up polygons
// (triangulation.h), the diagonals have half-edges but are not edges.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// Half-edge h = 3 f + k runs from F(f, k) to F(f, (k + 1) % 3), its face on its left.
inline int next_halfedge(int h) { return h % 3 == 2 ? h - 2 : h + 1; }
inline int previous_halfedge(int h) { return h % 3 == 0 ? h + 2 : h - 1; }
inline int halfedge_origin(const Triangles& F, int h) { return F.data()[h]; }
inline int halfedge_target(const Triangles& F, int h) { return F.data()[next_halfedge(h)]; }

/// The neighbours of vertex v are neighbor[start[v]] .. neighbor[start[v + 1] - 1], over the edges edge[...].
struct Neighbors {
  std::vector<int> start;
  std::vector<int> neighbor;
  std::vector<int> edge;
};

/// Which half-edges lie opposite to each other, and the undirected edges.
struct Connectivity {
  /// The undirected edges (i, j) with i < j, in lexicographic order.
  std::vector<std::array<int, 2>> edges;
  /// 3 m: the undirected edge of every half-edge; -1 for a diagonal.
  std::vector<int> edge_of;
  /// 3 m: the half-edge on the other side, or -1 on the boundary.
  std::vector<int> opposite;
};

/// The edges of an edge-manifold mesh of n vertices, in O(n + m). The mesh is expected to have passed
/// `inspect`.
Connectivity connectivity_of(const Triangles& F, int vertex_count);

Neighbors vertex_neighbors(const std::vector<std::array<int, 2>>& edges, int vertex_count);

}  // namespace orbitutte
