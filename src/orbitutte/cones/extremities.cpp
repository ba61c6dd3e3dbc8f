// SPDX-License-Identifier: MIT
// Farthest-point sampling: T. F. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985.
#include "orbitutte/cones/extremities.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/cut/cut.h"

namespace orbitutte {
namespace {

// The vertices that faces use, ascending.
struct Places {
  std::vector<int> inside, on_boundary;
};

Places places(const Surface& surface) {
  const Faces& F = surface.triangles;
  const int vertex_count = surface.vertex_count();
  Places result;
  std::vector<char> used(vertex_count, 0), outer(vertex_count, 0);
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    used[origin(F, h)] = 1;
    if (surface.connectivity.opposite[h] < 0) outer[origin(F, h)] = 1;
  }
  for (int v = 0; v < vertex_count; ++v)
    if (used[v]) (outer[v] ? result.on_boundary : result.inside).push_back(v);
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

std::vector<int> extremities(const Surface& surface, int inner, int outer) {
  const Places place = places(surface);
  if (inner > 0 && place.inside.empty())
    throw MeshError("one vertex has to be marked inside the surface, but all are on its boundary");
  require_enough(inner, place.inside);
  require_enough(outer, place.on_boundary);
  const EdgeGraph graph = edge_length_graph(surface);
  std::vector<int> result;
  const auto add = [&](const std::vector<int>& among, const std::vector<int>& first_from) {
    result.push_back(farthest(among, distances(graph, result.empty() ? first_from : result)));
  };
  for (int k = 0; k < inner; ++k)
    add(place.inside, place.on_boundary.empty() ? std::vector<int>{place.inside.front()} : place.on_boundary);
  for (int k = 0; k < outer; ++k) add(place.on_boundary, {place.on_boundary.front()});
  return result;
}

}  // namespace orbitutte
