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
  std::vector<double> length;  ///< per edge
  std::vector<char>
      dead_end;  ///< per vertex: 1 where a path may end but not go on; empty where there are none

  int vertex_count() const { return static_cast<int>(neighbors.start.size()) - 1; }
};

using Path = std::vector<int>;  ///< vertices, each the neighbour of the one before

/// The edge that joins two neighbours.
int edge_between(const EdgeGraph& graph, int v, int w);

/// Distances from the sources along the edges; infinity where none leads. Dijkstra, O(n log n).
std::vector<double> distances(const EdgeGraph& graph, const std::vector<int>& sources);

/// The shortest path from a vertex to the nearest of others, O(n log n). Empty where there is none.
Path shortest_path(const EdgeGraph& graph, int from, const std::vector<int>& to);

/// Two paths from one vertex to two others that share no vertex but the first, of least total length: a flow
/// of two units through vertices of capacity one (Suurballe 1974), two Dijkstra sweeps. On a triangulated
/// sphere they always exist, so no first path can block the second. The paths are in the order of `to`; both
/// empty where there are none.
std::array<Path, 2> disjoint_paths(const EdgeGraph& graph, int from, const std::array<int, 2>& to);

}  // namespace orbitutte
