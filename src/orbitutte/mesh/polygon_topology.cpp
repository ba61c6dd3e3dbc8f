// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/polygon_topology.h"

#include <algorithm>
#include <tuple>

namespace orbitutte {

PolygonTopology topology_of(const FaceView& faces) {
  PolygonTopology result;
  result.face_start = {0};
  for (int f = 0; f < faces.count(); ++f) {
    result.origin.insert(result.origin.end(), faces[f].begin(), faces[f].end());
    result.face_of.resize(result.origin.size(), f);
    result.face_start.push_back(result.corner_count());
  }
  std::vector<std::tuple<int, int, int>> sides;  // lower vertex, upper vertex, half-edge
  sides.reserve(result.origin.size());
  for (int c = 0; c < result.corner_count(); ++c) {
    const auto [lower, upper] = std::minmax({result.origin[c], result.target(c)});
    sides.emplace_back(lower, upper, c);
  }
  std::sort(sides.begin(), sides.end());
  result.twin.assign(result.origin.size(), -1);
  for (std::size_t k = 1; k < sides.size(); ++k) {
    const auto& [i, j, c] = sides[k - 1];
    const auto& [lower, upper, d] = sides[k];
    if (i != lower || j != upper) continue;
    result.twin[c] = d;
    result.twin[d] = c;
  }
  return result;
}

std::vector<char> boundary_vertices(const PolygonTopology& surface, int vertex_count) {
  std::vector<char> result(vertex_count, 0);
  for (int c = 0; c < surface.corner_count(); ++c)
    if (surface.twin[c] < 0) result[surface.origin[c]] = result[surface.target(c)] = 1;
  return result;
}

}  // namespace orbitutte
