// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/connectivity.h"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <utility>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// A half-edge among those with the same lower vertex: its upper vertex, then its number.
using Key = std::uint64_t;
Key key(int upper, int h) { return static_cast<Key>(upper) << 32 | static_cast<Key>(h); }
int upper_vertex(Key k) { return static_cast<int>(k >> 32); }
int halfedge(Key k) { return static_cast<int>(k & 0xffffffffu); }

// A counting sort of `count` items into buckets, in their order. Threads share the items: for_items(begin,
// end, visit) calls visit(bucket, item) for items begin .. end - 1, or several for each, and store(place,
// item) takes them in. Returns where buckets start.
template <typename ForItems, typename Store>
std::vector<int> sort_into_buckets(int count, int buckets, const ForItems& for_items, const Store& store) {
  constexpr int shortest = 10000, most = 8;
  const int parts = std::clamp(std::min(thread_count(), count / shortest), 1, most);
  const auto bound = [&](int part) { return static_cast<int>(static_cast<long long>(count) * part / parts); };
  // Of every part and bucket, how many items; then the place of the next.
  std::vector<std::vector<int>> next(parts);
  parallel_for(parts, [&](int part) {
    next[part].assign(buckets, 0);
    for_items(bound(part), bound(part + 1), [&](int bucket, const auto&) { ++next[part][bucket]; });
  });
  std::vector<int> start(buckets + 1);
  int place = 0;
  for (int bucket = 0; bucket < buckets; ++bucket) {
    start[bucket] = place;
    for (std::vector<int>& of_part : next) place += std::exchange(of_part[bucket], place);
  }
  start[buckets] = place;
  parallel_for(parts, [&](int part) {
    for_items(bound(part), bound(part + 1),
              [&](int bucket, const auto& item) { store(next[part][bucket]++, item); });
  });
  return start;
}

// A bucket has three keys or so.
void sort_keys(std::vector<Key>::iterator begin, std::vector<Key>::iterator end) {
  constexpr int many = 16;
  if (end - begin > many) return std::sort(begin, end);
  for (auto sorted = begin; sorted != end; ++sorted) {
    const Key inserted = *sorted;
    auto at = sorted;
    for (; at != begin && *(at - 1) > inserted; --at) *at = *(at - 1);
    *at = inserted;
  }
}

}  // namespace

Connectivity connectivity_of(const Triangles& F, int vertex_count) {
  std::vector<Key> keys(F.size());
  const auto for_halfedges = [&](int begin, int end, const auto& visit) {
    const int* corner = F.data() + 3 * static_cast<Eigen::Index>(begin);
    for (int h = 3 * begin; h < 3 * end; h += 3, corner += 3) {
      for (int k = 0; k < 3; ++k) {
        const auto [lower, upper] = std::minmax({corner[k], corner[k == 2 ? 0 : k + 1]});
        visit(lower, key(upper, h + k));
      }
    }
  };
  const std::vector<int> start =
      sort_into_buckets(static_cast<int>(F.rows()), vertex_count, for_halfedges,
                        [&](int place, Key halfedge_key) { keys[place] = halfedge_key; });
  std::vector<int> first_edge(vertex_count + 1, 0);
  parallel_ranges(vertex_count, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) {
      sort_keys(keys.begin() + start[v], keys.begin() + start[v + 1]);
      for (int k = start[v]; k < start[v + 1]; ++k)
        first_edge[v + 1] += k == start[v] || upper_vertex(keys[k]) != upper_vertex(keys[k - 1]);
    }
  });
  std::partial_sum(first_edge.begin(), first_edge.end(), first_edge.begin());

  Connectivity result;
  result.edge_of.resize(F.size());
  result.opposite.resize(F.size());
  result.edges.resize(first_edge.back());
  parallel_ranges(vertex_count, [&](int begin, int end) {
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
  result.neighbor.resize(2 * edges.size());
  result.edge.resize(2 * edges.size());
  const auto for_ends = [&](int begin, int end, const auto& visit) {
    for (int e = begin; e < end; ++e)
      for (const int side : {0, 1}) visit(edges[e][side], std::pair(edges[e][1 - side], e));
  };
  result.start = sort_into_buckets(static_cast<int>(edges.size()), vertex_count, for_ends,
                                   [&](int place, const std::pair<int, int>& neighbor_and_edge) {
                                     std::tie(result.neighbor[place], result.edge[place]) = neighbor_and_edge;
                                   });
  return result;
}

}  // namespace orbitutte
