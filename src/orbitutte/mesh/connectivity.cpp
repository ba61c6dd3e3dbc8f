// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/connectivity.h"

#include <algorithm>
#include <cstdint>
#include <numeric>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// A half-edge among those with the same lower vertex: its upper vertex, then its number.
using Key = std::uint64_t;
Key key(int upper, int h) { return static_cast<Key>(upper) << 32 | static_cast<Key>(h); }
int upper_vertex(Key k) { return static_cast<int>(k >> 32); }
int halfedge(Key k) { return static_cast<int>(k & 0xffffffffu); }

// Calls visit(lower, upper, half-edge) for every half-edge whose lower vertex is in begin .. end - 1, in
// ascending order.
template <typename Visit>
void for_halfedges(const Triangles& F, int begin, int end, const Visit& visit) {
  const int* corner = F.data();
  for (int h = 0, size = static_cast<int>(F.size()); h < size; h += 3, corner += 3) {
    for (int k = 0; k < 3; ++k) {
      const auto [lower, upper] = std::minmax({corner[k], corner[k == 2 ? 0 : k + 1]});
      if (lower >= begin && lower < end) visit(lower, upper, h + k);
    }
  }
}

}  // namespace

Connectivity connectivity_of(const Triangles& F, int vertex_count) {
  // A counting sort by the lower vertex, then a sort of each short bucket.
  std::vector<int> start(vertex_count + 1, 0), first_edge(vertex_count + 1, 0);
  parallel_parts(vertex_count, [&](int begin, int end) {
    for_halfedges(F, begin, end, [&](int lower, int, int) { ++start[lower + 1]; });
  });
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<Key> keys(F.size());
  parallel_parts(vertex_count, [&](int begin, int end) {
    std::vector<int> fill(start.begin() + begin, start.begin() + end);
    for_halfedges(F, begin, end,
                  [&](int lower, int upper, int h) { keys[fill[lower - begin]++] = key(upper, h); });
    for (int v = begin; v < end; ++v) {
      std::sort(keys.begin() + start[v], keys.begin() + start[v + 1]);
      for (int k = start[v]; k < start[v + 1]; ++k)
        first_edge[v + 1] += k == start[v] || upper_vertex(keys[k]) != upper_vertex(keys[k - 1]);
    }
  });
  std::partial_sum(first_edge.begin(), first_edge.end(), first_edge.begin());

  Connectivity result;
  result.edge_of.resize(F.size());
  result.opposite.resize(F.size());
  result.edges.resize(first_edge.back());
  parallel_parts(vertex_count, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      int edge = first_edge[v] - 1;
      for (int k = start[v]; k < start[v + 1]; ++k) {
        const int h = halfedge(keys[k]);
        const bool again = k > start[v] && upper_vertex(keys[k]) == upper_vertex(keys[k - 1]);
        if (!again) result.edges[++edge] = {v, upper_vertex(keys[k])};
        result.edge_of[h] = edge;
        result.opposite[h] = again ? halfedge(keys[k - 1]) : -1;
        if (again) result.opposite[halfedge(keys[k - 1])] = h;
      }
    }
  });
  return result;
}

Neighbors vertex_neighbors(const std::vector<std::array<int, 2>>& edges, int vertex_count) {
  Neighbors result;
  result.start.assign(vertex_count + 1, 0);
  parallel_parts(vertex_count, [&](int begin, int end) {
    for (const auto& ends : edges)
      for (const int v : ends)
        if (v >= begin && v < end) ++result.start[v + 1];
  });
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.neighbor.resize(2 * edges.size());
  result.edge.resize(2 * edges.size());
  parallel_parts(vertex_count, [&](int begin, int end) {
    std::vector<int> fill(result.start.begin() + begin, result.start.begin() + end);
    for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
      for (const int side : {0, 1}) {
        const int v = edges[e][side];
        if (v < begin || v >= end) continue;
        const int at = fill[v - begin]++;
        result.neighbor[at] = edges[e][1 - side];
        result.edge[at] = e;
      }
    }
  });
  return result;
}

}  // namespace orbitutte
