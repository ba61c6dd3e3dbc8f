// SPDX-License-Identifier: MIT
#include "orbitutte/warnings.h"

#include <fmt/format.h>

#include <algorithm>
#include <unordered_set>

namespace orbitutte {
namespace {

// How many of the faces are among the collapsing ones, or share an edge with one of them at the least.
long count_in_or_beside(const std::vector<int>& collapsing, const FaceView& faces,
                        const std::vector<int>& among) {
  std::unordered_set<int> vertices;
  for (const int f : collapsing) vertices.insert(faces[f].begin(), faces[f].end());
  return std::count_if(among.begin(), among.end(), [&](int f) {
    return std::count_if(faces[f].begin(), faces[f].end(), [&](int v) { return vertices.count(v) > 0; }) > 1;
  });
}

}  // namespace

std::vector<std::string> warnings_about(const EdgeWeights& weights, const std::vector<Ear>& ears) {
  std::vector<std::string> warnings;
  if (weights.zero_edges > 0)
    warnings.push_back(fmt::format("{} edges have the weight zero; the theory asks for positive weights",
                                   weights.zero_edges));
  if (!ears.empty())
    warnings.push_back(fmt::format(
        "{} faces have all edges but one on one mirror or held side and must become arcs, the first face {}: "
        "their areas are rounding errors; swap their inner edges, or mark their tips",
        count_faces(ears), ears.front().face));
  return warnings;
}

std::vector<std::vector<int>> mirrors_of(const Tile& tile, const BoundaryConditions& boundary,
                                         const std::vector<int>& source_vertex) {
  std::vector<std::vector<int>> mirrors;
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    if (!tile.sides[s].held() && tile.sides[s].partner != static_cast<int>(s)) continue;
    std::vector<int>& mirror = mirrors.emplace_back();
    for (const int v : boundary.sides[s]) mirror.push_back(source_vertex[v]);
  }
  return mirrors;
}

std::vector<std::string> warnings_of_collapse(const FaceView& faces, const std::vector<int>& collapsing,
                                              const std::vector<int>& nonpositive) {
  const long unavoidable = count_in_or_beside(collapsing, faces, nonpositive);
  if (unavoidable == 0) return {};
  return {
      fmt::format("{} of the {} faces that are not positively oriented must become arcs, or lie beside such "
                  "faces, the first "
                  "face {}: the mesh is not 3-connected there, and no failure of the solver (see 'orbitutte "
                  "info'); mark a "
                  "vertex there, or give it further edges",
                  unavoidable, nonpositive.size(), collapsing.front())};
}

}  // namespace orbitutte
