// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/connectivity.h"

#include <algorithm>
#include <numeric>

namespace orbitutte {
namespace {

// Half-edges sorted by (lower vertex, upper vertex): a counting sort over the lower one, then a sort of each
// short bucket.
std::vector<int> sorted_halfedges(const Faces& F, int vertex_count) {
  const int halfedges = static_cast<int>(F.size());
  const auto lower = [&](int h) { return std::min(origin(F, h), target(F, h)); };
  const auto upper = [&](int h) { return std::max(origin(F, h), target(F, h)); };

  std::vector<int> start(vertex_count + 1, 0);
  for (int h = 0; h < halfedges; ++h) ++start[lower(h) + 1];
  std::partial_sum(start.begin(), start.end(), start.begin());
  std::vector<int> order(halfedges), fill(start.begin(), start.end() - 1);
  for (int h = 0; h < halfedges; ++h) order[fill[lower(h)]++] = h;
  for (int v = 0; v < vertex_count; ++v) {
    std::sort(order.begin() + start[v], order.begin() + start[v + 1],
              [&](int a, int b) { return std::pair(upper(a), a) < std::pair(upper(b), b); });
  }
  return order;
}

}  // namespace

Connectivity connect(const Faces& F, int vertex_count) {
  Connectivity result;
  result.edge_of.assign(F.size(), -1);
  result.opposite.assign(F.size(), -1);
  result.edges.reserve(F.size() / 2 + 1);
  int previous = -1;
  for (const int h : sorted_halfedges(F, vertex_count)) {
    const auto [i, j] = std::minmax({origin(F, h), target(F, h)});
    const std::array<int, 2> edge = {i, j};
    if (previous >= 0 && result.edges.back() == edge) {
      result.opposite[h] = previous;
      result.opposite[previous] = h;
    } else {
      result.edges.push_back(edge);
    }
    result.edge_of[h] = static_cast<int>(result.edges.size()) - 1;
    previous = h;
  }
  return result;
}

Neighbors neighbors(const std::vector<std::array<int, 2>>& edges, int vertex_count) {
  Neighbors result;
  result.start.assign(vertex_count + 1, 0);
  for (const auto& [i, j] : edges) {
    ++result.start[i + 1];
    ++result.start[j + 1];
  }
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.neighbor.resize(2 * edges.size());
  result.edge.resize(2 * edges.size());
  std::vector<int> fill(result.start.begin(), result.start.end() - 1);
  for (int e = 0; e < static_cast<int>(edges.size()); ++e) {
    const auto [i, j] = edges[e];
    result.neighbor[fill[i]] = j;
    result.edge[fill[i]++] = e;
    result.neighbor[fill[j]] = i;
    result.edge[fill[j]++] = e;
  }
  return result;
}

}  // namespace orbitutte
