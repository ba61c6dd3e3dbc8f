// SPDX-License-Identifier: MIT
// Shortest paths along weighted edges. On 490,000 vertices Boost.Graph (1.74) needs eleven times as long for
// two disjoint paths, as a flow of least cost, and refuses lengths whose differences are rounded below zero;
// its Dijkstra alone, on an adapter to EdgeGraph, takes 0.6 of the time.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// A graph of vertices and edges of nonnegative length.
struct EdgeGraph {
  Neighbors neighbors;
  /// Per edge.
  std::vector<double> length;
  /// Per vertex: 1 if a path may end there but not go on. Empty if there are no such vertices.
  std::vector<char> dead_end;

  int vertex_count() const { return static_cast<int>(neighbors.start.size()) - 1; }
};

/// Vertices, each a neighbour of the one before.
using Path = std::vector<int>;

/// The edge that joins two neighbours.
int edge_between(const EdgeGraph& graph, int v, int w);

/// Distances from the sources along the edges; infinity if no path leads to a vertex. Dijkstra, O(n log n).
std::vector<double> distances(const EdgeGraph& graph, const std::vector<int>& sources);

/// The shortest path from a vertex to the nearest vertex of `to`, O(n log n). Empty if there is none.
Path shortest_path(const EdgeGraph& graph, int from, const std::vector<int>& to);

/// Two paths from one vertex to two others that share only that vertex, of least total length. They are a
/// flow of two units through vertices of capacity one (Suurballe 1974), found by two Dijkstra sweeps. On a
/// triangulated sphere they always exist: no first path can block the second. The paths are in the order of
/// `to`; both are empty if there are none.
///
/// `left`, for every vertex, is a lower bound of the distance left to the nearer of `to`, such that it
/// differs by no more than an edge's length between its ends: the searches go towards `to` (P. Hart, N.
/// Nilsson, B. Raphael, IEEE Trans. Systems Science and Cybernetics 4 (1968)). Empty for zero.
std::array<Path, 2> disjoint_paths(const EdgeGraph& graph, int from, const std::array<int, 2>& to,
                                   std::vector<double> left = {});

/// The edges of a tree that joins all of `to` to the roots: each is the nearest to the tree of those that
/// were left, and joined to it by a shortest path. No path passes through a root. Empty if one cannot be
/// reached.
std::vector<int> tree_edges(const EdgeGraph& graph, const std::vector<int>& roots,
                            const std::vector<int>& to);

}  // namespace orbitutte
