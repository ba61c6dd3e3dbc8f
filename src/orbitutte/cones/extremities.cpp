// SPDX-License-Identifier: MIT
// Farthest-point sampling: T. F. Gonzalez, "Clustering to minimize the maximum intercluster distance", 1985.
#include "orbitutte/cones/extremities.h"

#include <fmt/format.h>

#include <algorithm>
#include <span>

#include "orbitutte/cut/cut.h"

namespace orbitutte {
namespace {

// The vertices that faces use, ascending.
struct PossiblePlaces {
  std::vector<int> inside, on_boundary;
};

PossiblePlaces places(const Surface& surface) {
  const Triangles& F = surface.triangles;
  const int vertex_count = surface.vertex_count();
  PossiblePlaces result;
  std::vector<char> used(vertex_count, 0), outer(vertex_count, 0);
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    used[halfedge_origin(F, h)] = 1;
    if (surface.connectivity.opposite[h] < 0) outer[halfedge_origin(F, h)] = 1;
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

// Vertices for marks no two of which an edge joins.
class Separation {
 public:
  Separation(const Neighbors& graph, const std::vector<int>& among)
      : graph_(graph), among_(among), may_be_marked_(graph.start.size() - 1, 0) {
    for (const int v : among) may_be_marked_[v] = 1;
  }

  // Those that no edge joins to any of the marked ones. For the first mark: those that leave one for the
  // next. All, if there are none such.
  std::vector<int> apart_from(const std::vector<int>& marked) const {
    std::vector<int> result;
    for (const int v : among_)
      if (marked.empty() ? leaves_others(v) : !touches(v, marked)) result.push_back(v);
    return result.empty() ? among_ : result;
  }

 private:
  template <class Test>
  std::size_t count_neighbours(int v, const Test& test) const {
    return static_cast<std::size_t>(std::count_if(graph_.neighbor.begin() + graph_.start[v],
                                                  graph_.neighbor.begin() + graph_.start[v + 1], test));
  }

  bool leaves_others(int v) const {
    return count_neighbours(v, [&](int w) { return may_be_marked_[w] != 0; }) + 1 < among_.size();
  }

  bool touches(int v, const std::vector<int>& marked) const {
    const auto is_marked = [&](int w) { return std::find(marked.begin(), marked.end(), w) != marked.end(); };
    return is_marked(v) || count_neighbours(v, is_marked) > 0;
  }

  const Neighbors& graph_;
  const std::vector<int>& among_;
  std::vector<char> may_be_marked_;
};

// How many vertices of the boundary come between `first` and each of them, the mesh on the left; `first` has
// 0.
std::vector<int> places_from(int first, const Surface& surface) {
  std::vector<int> next(surface.vertex_count(), -1);
  for (int h = 0; h < static_cast<int>(surface.triangles.size()); ++h)
    if (surface.connectivity.opposite[h] < 0)
      next[halfedge_origin(surface.triangles, h)] = halfedge_target(surface.triangles, h);
  std::vector<int> place(surface.vertex_count(), 0);
  for (int v = next[first], k = 1; v != first; v = next[v]) place[v] = k++;
  return place;
}

// Brings vertices of the boundary into an order in which it meets them, from the first on, in the direction
// that comes to the second before the third.
void order_around(const Surface& surface, std::span<int> marks) {
  if (marks.size() < 4) return;  // in whichever order, they go around
  std::vector<int> place = places_from(marks[0], surface);
  if (place[marks[1]] > place[marks[2]])
    for (const int v : marks.subspan(1)) place[v] = -place[v];
  std::sort(marks.begin() + 1, marks.end(), [&](int a, int b) { return place[a] < place[b]; });
}

}  // namespace

std::vector<int> choose_extremities(const Surface& surface, const WantedExtremities& wanted) {
  const PossiblePlaces place = places(surface);
  if (wanted.inner > 0 && place.inside.empty())
    throw MeshError("one vertex has to be marked inside the surface, but all are on its boundary");
  require_enough(wanted.inner, place.inside);
  require_enough(wanted.outer, place.on_boundary);
  const EdgeGraph graph = edge_length_graph(surface);
  std::vector<int> result;
  const auto add = [&](const std::vector<int>& among, const std::vector<int>& first_from) {
    const std::vector<double> distance = distances(graph, result.empty() ? first_from : result);
    result.push_back(farthest(
        wanted.no_neighbours ? Separation(graph.neighbors, among).apart_from(result) : among, distance));
  };
  for (int k = 0; k < wanted.inner; ++k)
    add(place.inside, place.on_boundary.empty() ? std::vector<int>{place.inside.front()} : place.on_boundary);
  for (int k = 0; k < wanted.outer; ++k) add(place.on_boundary, {place.on_boundary.front()});
  order_around(surface, std::span(result).subspan(wanted.inner));
  return result;
}

}  // namespace orbitutte
