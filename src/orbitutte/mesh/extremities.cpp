// SPDX-License-Identifier: MIT
// Farthest-point sampling: T. F. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985.
#include "orbitutte/mesh/extremities.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "orbitutte/mesh/cut.h"

namespace orbitutte {
namespace {

// The vertices that faces use, ascending.
struct Places {
  std::vector<int> inside, on_boundary;
  std::vector<char> is_on_boundary;  // of every vertex
};

Places places(const Faces& F, const Connectivity& connectivity, int vertex_count) {
  Places result;
  std::vector<char> used(vertex_count, 0);
  result.is_on_boundary.assign(vertex_count, 0);
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    used[origin(F, h)] = 1;
    if (connectivity.opposite[h] < 0) result.is_on_boundary[origin(F, h)] = 1;
  }
  for (int v = 0; v < vertex_count; ++v)
    if (used[v]) (result.is_on_boundary[v] ? result.on_boundary : result.inside).push_back(v);
  return result;
}

int farthest(const std::vector<int>& among, const std::vector<double>& distance) {
  return *std::max_element(among.begin(), among.end(),
                           [&](int a, int b) { return distance[a] < distance[b]; });
}

void require_enough(int wanted, const std::vector<int>& among) {
  if (static_cast<int>(among.size()) < wanted)
    throw MeshError(fmt::format("{} vertices have to be marked, but only {} can be", wanted, among.size()));
}

}  // namespace

std::vector<int> extremities(const Mesh& mesh, const Connectivity& connectivity, int inner, int outer) {
  const Places place = places(mesh.F, connectivity, static_cast<int>(mesh.V.rows()));
  require_enough(inner, place.inside);
  EdgeGraph graph = edge_length_graph(mesh, connectivity);
  std::vector<int> result;
  const auto add = [&](const std::vector<int>& among, const std::vector<int>& first_from) {
    result.push_back(farthest(among, distances(graph, result.empty() ? first_from : result)));
  };
  for (int k = 0; k < inner; ++k)
    add(place.inside, place.on_boundary.empty() ? std::vector<int>{place.inside.front()} : place.on_boundary);
  std::vector<int> reached = place.on_boundary;
  if (inner > 0 && outer > 0) {
    graph.dead_end = place.is_on_boundary;
    const std::vector<double> distance = distances(graph, result);
    std::erase_if(reached, [&](int v) { return !std::isfinite(distance[v]); });
    graph.dead_end.clear();
  }
  require_enough(outer, reached);
  for (int k = 0; k < outer; ++k) add(reached, {reached.front()});
  return result;
}

}  // namespace orbitutte
