// SPDX-License-Identifier: MIT
// Farthest-point sampling: T. F. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985.
#include "orbitutte/mesh/extremities.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/mesh/cut.h"

namespace orbitutte {
namespace {

// The vertices on the boundary, or all that faces use where there is none; ascending.
std::vector<int> candidates(const Faces& F, const Connectivity& connectivity, int vertex_count) {
  std::vector<char> used(vertex_count, 0), outer(vertex_count, 0);
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    used[origin(F, h)] = 1;
    if (connectivity.opposite[h] < 0) outer[origin(F, h)] = 1;
  }
  const bool closed = std::find(outer.begin(), outer.end(), 1) == outer.end();
  std::vector<int> result;
  for (int v = 0; v < vertex_count; ++v)
    if (closed ? used[v] : outer[v]) result.push_back(v);
  return result;
}

int farthest(const std::vector<int>& among, const std::vector<double>& distance) {
  return *std::max_element(among.begin(), among.end(),
                           [&](int a, int b) { return distance[a] < distance[b]; });
}

}  // namespace

std::vector<int> extremities(const Mesh& mesh, const Connectivity& connectivity, int count) {
  const std::vector<int> among = candidates(mesh.F, connectivity, static_cast<int>(mesh.V.rows()));
  if (static_cast<int>(among.size()) < count)
    throw MeshError(fmt::format("{} vertices have to be marked, but only {} can be", count, among.size()));
  const EdgeGraph graph = edge_length_graph(mesh, connectivity);
  std::vector<int> result = {farthest(among, distances(graph, {among.front()}))};
  while (static_cast<int>(result.size()) < count) result.push_back(farthest(among, distances(graph, result)));
  return result;
}

}  // namespace orbitutte
