// SPDX-License-Identifier: MIT
#include "orbitutte/verify/exact_group.h"

#include <algorithm>
#include <limits>
#include <unordered_map>

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/orbifold/polygon.h"

namespace orbitutte {
namespace {

// The cut vertices around the boundary, counterclockwise.
std::vector<int> boundary_loop(const Embedding& embedding) {
  const Triangles& F = embedding.triangles;
  const Connectivity connectivity = connectivity_of(F, static_cast<int>(embedding.source_vertex.size()));
  std::unordered_map<int, int> next;
  for (int h = 0; h < static_cast<int>(F.size()); ++h)
    if (connectivity.opposite[h] < 0) next[halfedge_origin(F, h)] = halfedge_target(F, h);
  std::vector<int> loop;
  if (next.empty()) return loop;
  for (int v = next.begin()->first; loop.size() < next.size(); v = next[v]) loop.push_back(v);
  return loop;
}

// Where group_of_boundary has a loop begin: at a copy of the first cone, of the first corner, or at the first
// of the ends of mirrors.
bool begins_at(const Embedding& embedding, const Target& target, int v) {
  const int source = embedding.source_vertex[v];
  const auto first = static_cast<std::size_t>(target.topology == Topology::sphere ? 0 : target.inner_marks);
  if (first < embedding.cones.size()) return source == embedding.cones[first].vertex;
  int least = std::numeric_limits<int>::max();
  for (const Seam& seam : embedding.seams)
    if (seam.is_mirror())
      for (const int end : {seam.left.front(), seam.left.back()})
        least = std::min(least, embedding.source_vertex[end]);
  return source == least;
}

}  // namespace

PreciseGroup<MostPrecise> exact_group(const Embedding& embedding, const ExactPositions& positions) {
  const Target target = read_target(embedding.target.signature, embedding.cones, embedding.positions);
  if (!target.has_free_tile) return PreciseGroup<MostPrecise>(target);
  std::vector<int> loop = boundary_loop(embedding);
  const auto start =
      std::find_if(loop.begin(), loop.end(), [&](int v) { return begins_at(embedding, target, v); });
  if (start == loop.end()) throw ArgumentError("the boundary of the cut mesh meets no mark");
  std::rotate(loop.begin(), start, loop.end());
  return group_of_boundary<MostPrecise>(target, {std::move(loop), embedding.source_vertex, embedding.seams,
                                                 embedding.cones, [&](int v) { return positions.exact(v); }});
}

}  // namespace orbitutte
