// SPDX-License-Identifier: MIT
// A one-sided loop through a vertex is a path in the orientable double cover from one lift of the vertex to
// the other.
#include "orbitutte/cut/one_sided_loop.h"

#include <algorithm>
#include <stdexcept>
#include <unordered_map>

#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

bool same_direction(const Triangles& F, int h, int other) {
  return halfedge_origin(F, h) == halfedge_origin(F, other);
}

// Numbers the corners of the double cover: corner h of a face on sheet 0 or 1.
int lift(int h, int sheet) { return 2 * h + sheet; }

// Unites the corners of the double cover that are one vertex there. Sheet 0 holds every face as it is, sheet
// 1 turned over. Crossing an edge changes the sheet if both faces run along it in the same direction.
DisjointSets vertices_of_double_cover(const Triangles& F, const std::vector<int>& opposite) {
  DisjointSets vertices(2 * static_cast<int>(F.size()));
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    const int other = opposite[h];
    const bool same = same_direction(F, h, other);
    const int at_origin = same ? other : next_halfedge(other),
              at_target = same ? next_halfedge(other) : other;
    for (const int sheet : {0, 1}) {
      vertices.unite(lift(h, sheet), lift(at_origin, sheet ^ same));
      vertices.unite(lift(next_halfedge(h), sheet), lift(at_target, sheet ^ same));
    }
  }
  return vertices;
}

// Per edge: does it join different lifts of its ends? Lift 0 of a vertex is that of its first corner on sheet
// 0.
std::vector<char> lift_changes(const Surface& surface) {
  const Triangles& F = surface.triangles;
  const Connectivity& connectivity = surface.connectivity;
  DisjointSets vertices = vertices_of_double_cover(F, connectivity.opposite);
  std::vector<int> first(surface.vertex_count(), -1);
  for (int h = 0; h < static_cast<int>(F.size()); ++h)
    if (first[halfedge_origin(F, h)] < 0) first[halfedge_origin(F, h)] = vertices.find(lift(h, 0));
  const auto lift_of = [&](int h) { return vertices.find(lift(h, 0)) != first[halfedge_origin(F, h)]; };
  std::vector<char> changes(connectivity.edges.size());
  for (int h = 0; h < static_cast<int>(F.size()); ++h)
    if (const int e = connectivity.edge_of[h]; e >= 0) changes[e] = lift_of(h) != lift_of(next_halfedge(h));
  return changes;
}

std::vector<std::array<int, 2>> edges_of(const EdgeGraph& graph) {
  std::vector<std::array<int, 2>> edges(graph.length.size());
  for (int v = 0; v < graph.vertex_count(); ++v)
    for (int k = graph.neighbors.start[v]; k < graph.neighbors.start[v + 1]; ++k)
      if (v < graph.neighbors.neighbor[k]) edges[graph.neighbors.edge[k]] = {v, graph.neighbors.neighbor[k]};
  return edges;
}

// The lifts of vertex v are v and n + v.
EdgeGraph double_cover(const EdgeGraph& graph, const std::vector<char>& changes) {
  const int n = graph.vertex_count();
  std::vector<std::array<int, 2>> edges;
  EdgeGraph cover;
  const std::vector<std::array<int, 2>> ends = edges_of(graph);
  for (std::size_t e = 0; e < ends.size(); ++e) {
    const auto [i, j] = ends[e];
    edges.push_back({i, changes[e] ? n + j : j});
    edges.push_back({n + i, changes[e] ? j : n + j});
    cover.length.insert(cover.length.end(), 2, graph.length[e]);
  }
  cover.neighbors = vertex_neighbors(edges, 2 * n);
  return cover;
}

// The shortest closed part of a path. It passes no vertex twice.
Path innermost_loop(const Path& path) {
  std::unordered_map<int, std::size_t> last;
  std::size_t begin = 0, end = path.size() - 1;
  for (std::size_t k = 0; k < path.size(); ++k) {
    const auto [at, is_new] = last.try_emplace(path[k], k);
    if (!is_new && k - at->second < end - begin) begin = at->second, end = k;
    at->second = k;
  }
  return {path.begin() + static_cast<std::ptrdiff_t>(begin),
          path.begin() + static_cast<std::ptrdiff_t>(end) + 1};
}

// Two paths from a vertex to different vertices of a loop that share no other vertex. To find them, every
// vertex of the loop is joined to two new vertices by edges of length zero.
std::array<Path, 2> paths_to_loop(const EdgeGraph& graph, int vertex, const Path& loop) {
  const int n = graph.vertex_count();
  std::vector<std::array<int, 2>> edges = edges_of(graph);
  EdgeGraph joined;
  joined.length = graph.length;
  for (std::size_t k = 1; k < loop.size(); ++k) {
    for (const int sink : {n, n + 1}) {
      edges.push_back({loop[k], sink});
      joined.length.push_back(0);
    }
  }
  joined.neighbors = vertex_neighbors(edges, n + 2);
  std::array<Path, 2> paths = disjoint_paths(joined, vertex, {n, n + 1});
  for (Path& path : paths) path.pop_back();
  return paths;
}

bool turns_over(const Path& path, const EdgeGraph& graph, const std::vector<char>& changes) {
  bool turned = false;
  for (std::size_t k = 1; k < path.size(); ++k)
    turned ^= changes[edge_between(graph, path[k - 1], path[k])] != 0;
  return turned;
}

Path concatenated(Path first, const Path& second) {
  first.insert(first.end(), second.begin() + 1, second.end());
  return first;
}

// The closed path along the first path, around a part of the loop to the end of the second path, and back
// along it.
Path closed_along(const std::array<Path, 2>& paths, Path loop) {
  loop.pop_back();
  std::rotate(loop.begin(), std::find(loop.begin(), loop.end(), paths[0].back()), loop.end());
  const auto end = std::find(loop.begin(), loop.end(), paths[1].back());
  return concatenated(concatenated(paths[0], Path(loop.begin(), end + 1)),
                      Path(paths[1].rbegin(), paths[1].rend()));
}

}  // namespace

bool has_turned_faces(const Triangles& F, const std::vector<int>& opposite) {
  return parallel_max(static_cast<int>(F.size()), [&](int h) {
           return opposite[h] >= 0 && same_direction(F, h, opposite[h]) ? 1.0 : 0.0;
         }) > 0;
}

Path one_sided_loop(const EdgeGraph& graph, const Surface& surface, int vertex) {
  const int n = graph.vertex_count();
  const std::vector<char> changes = lift_changes(surface);
  Path path = shortest_path(double_cover(graph, changes), vertex, {n + vertex});
  if (path.empty()) throw std::logic_error("the surface has an orientation");
  for (int& v : path) v %= n;
  const Path loop = innermost_loop(path);
  if (loop.size() == path.size()) return path;
  const std::array<Path, 2> paths = paths_to_loop(graph, vertex, loop);
  // The two ways around the loop differ by the whole loop, so one of them reverses orientation.
  const Path one_way = closed_along(paths, loop);
  return turns_over(one_way, graph, changes) ? one_way
                                             : closed_along(paths, Path(loop.rbegin(), loop.rend()));
}

Triangles agreeing_faces(const Triangles& F, const std::vector<int>& opposite) {
  std::vector<char> turned(F.rows(), 0), met(F.rows(), 0);
  std::vector<int> front = {0};
  met[0] = 1;
  while (!front.empty()) {
    const int f = front.back();
    front.pop_back();
    for (int h = 3 * f; h < 3 * f + 3; ++h) {
      const int other = opposite[h];
      if (other < 0 || met[other / 3]) continue;
      met[other / 3] = 1;
      turned[other / 3] = turned[f] != same_direction(F, h, other);
      front.push_back(other / 3);
    }
  }
  Triangles result = F;
  for (Eigen::Index f = 0; f < F.rows(); ++f)
    if (turned[f]) std::swap(result(f, 1), result(f, 2));
  return result;
}

}  // namespace orbitutte
