// SPDX-License-Identifier: MIT
#include "orbitutte/cut/paths.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <set>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "random_spheres.h"

namespace orbitutte::paths_test {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Graph {
  std::vector<std::array<int, 2>> edges;
  EdgeGraph graph;

  int size() const { return graph.vertex_count(); }

  /// Of the edge between two vertices; infinite where there is none.
  double length(int v, int w) const {
    const auto at = std::find(edges.begin(), edges.end(), std::array<int, 2>{std::min(v, w), std::max(v, w)});
    return at == edges.end() ? infinity : graph.length[at - edges.begin()];
  }
  double length(const Path& path) const {
    double sum = 0;
    for (std::size_t k = 1; k < path.size(); ++k) sum += length(path[k - 1], path[k]);
    return sum;
  }
};

/// Up to `largest` vertices, each pair joined with the given odds out of 4. The lengths are small whole
/// numbers, so that sums are exact and ties frequent.
Graph random_graph(int smallest, int largest, int odds) {
  Graph result;
  const int n = *rc::gen::inRange(smallest, largest + 1);
  for (int i = 0; i < n; ++i) {
    for (int j = i + 1; j < n; ++j) {
      if (*rc::gen::inRange(0, 4) >= odds) continue;
      result.edges.push_back({i, j});
      result.graph.length.push_back(*rc::gen::inRange(0, 6));
    }
  }
  result.graph.neighbors = vertex_neighbors(result.edges, n);
  return result;
}

/// Floyd and Warshall.
std::vector<std::vector<double>> all_distances(const Graph& graph) {
  const int n = graph.size();
  std::vector<std::vector<double>> d(n, std::vector<double>(n));
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) d[i][j] = i == j ? 0 : graph.length(i, j);
  for (int k = 0; k < n; ++k)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) d[i][j] = std::min(d[i][j], d[i][k] + d[k][j]);
  return d;
}

/// All paths without repeated vertices that begin like `path`, end at `to` and avoid `avoided`.
void extend(const Graph& graph, int to, const std::set<int>& avoided, Path& path, std::vector<Path>& all) {
  if (path.back() == to) {
    all.push_back(path);
    return;
  }
  for (int v = 0; v < graph.size(); ++v) {
    if (avoided.count(v) || std::count(path.begin(), path.end(), v) ||
        graph.length(path.back(), v) == infinity)
      continue;
    path.push_back(v);
    extend(graph, to, avoided, path, all);
    path.pop_back();
  }
}

std::vector<Path> all_paths(const Graph& graph, int from, int to, const std::set<int>& avoided) {
  std::vector<Path> all;
  Path path = {from};
  extend(graph, to, avoided, path, all);
  return all;
}

/// The least total length of two paths that share their first vertex only; infinite where there are none.
double least_disjoint_length(const Graph& graph, int from, const std::array<int, 2>& to) {
  double least = infinity;
  for (const Path& first : all_paths(graph, from, to[0], {to[1]})) {
    const std::set<int> taken(first.begin() + 1, first.end());
    for (const Path& second : all_paths(graph, from, to[1], taken))
      least = std::min(least, graph.length(first) + graph.length(second));
  }
  return least;
}

/// Goes from one vertex to the other along edges, and meets no vertex twice.
bool is_path(const Graph& graph, const Path& path, int from, int to) {
  return !path.empty() && path.front() == from && path.back() == to && graph.length(path) < infinity &&
         std::set<int>(path.begin(), path.end()).size() == path.size();
}

bool share_only_the_first(const std::array<Path, 2>& paths) {
  const std::set<int> first(paths[0].begin() + 1, paths[0].end());
  return std::none_of(paths[1].begin() + 1, paths[1].end(), [&](int v) { return first.count(v) > 0; });
}

Graph graph_with_lengths(const Mesh& mesh) {
  const Connectivity connectivity = connectivity_of(mesh.F, test::vertex_count(mesh));
  return {connectivity.edges, edge_length_graph(test::unjudged(mesh))};
}

/// Do two disjoint paths go from this vertex to any two others?
bool has_disjoint_paths(const Graph& graph, int from) {
  for (int a = 0; a < graph.size(); ++a) {
    for (int b = 0; b < a; ++b) {
      if (a == from || b == from) continue;
      const std::array<Path, 2> paths = disjoint_paths(graph.graph, from, {a, b});
      if (!is_path(graph, paths[0], from, a) || !is_path(graph, paths[1], from, b) ||
          !share_only_the_first(paths))
        return false;
    }
  }
  return true;
}

/// The first of the vertices without them, or nothing.
std::optional<int> without_disjoint_paths(const Mesh& mesh) {
  const Graph graph = graph_with_lengths(mesh);
  for (int from = 0; from < graph.size(); ++from)
    if (!has_disjoint_paths(graph, from)) return from;
  return {};
}

// ------------------------------------------------------------------------------------------ shortest paths

RC_GTEST_PROP(Paths, DistancesAreThoseOfFloydAndWarshall, ()) {
  const Graph graph = random_graph(1, 9, *rc::gen::inRange(1, 4));
  const auto expected = all_distances(graph);
  for (int v = 0; v < graph.size(); ++v) RC_ASSERT(distances(graph.graph, {v}) == expected[v]);
}

RC_GTEST_PROP(Paths, DistancesFromManySourcesAreThoseFromTheNearest, ()) {
  const Graph graph = random_graph(2, 9, 2);
  const auto expected = all_distances(graph);
  const int a = *rc::gen::inRange(0, graph.size()), b = *rc::gen::inRange(0, graph.size());
  const std::vector<double> d = distances(graph.graph, {a, b});
  for (int v = 0; v < graph.size(); ++v) RC_ASSERT(d[v] == std::min(expected[a][v], expected[b][v]));
}

RC_GTEST_PROP(Paths, ShortestPathsHaveTheLengthOfTheDistance, ()) {
  const Graph graph = random_graph(2, 9, *rc::gen::inRange(1, 4));
  const auto expected = all_distances(graph);
  for (int a = 0; a < graph.size(); ++a) {
    for (int b = 0; b < graph.size(); ++b) {
      const Path path = shortest_path(graph.graph, a, {b});
      RC_ASSERT(path.empty() == (expected[a][b] == infinity));
      if (path.empty()) continue;
      RC_ASSERT(is_path(graph, path, a, b));
      RC_ASSERT(graph.length(path) == expected[a][b]);
    }
  }
}

RC_GTEST_PROP(Paths, ThePathToTheNearestOfManyIsTheShortest, ()) {
  const Graph graph = random_graph(2, 9, *rc::gen::inRange(1, 4));
  const auto expected = all_distances(graph);
  const int a = *rc::gen::inRange(0, graph.size());
  const std::vector<int> to = {*rc::gen::inRange(0, graph.size()), *rc::gen::inRange(0, graph.size())};
  const Path path = shortest_path(graph.graph, a, to);
  const double distance = std::min(expected[a][to[0]], expected[a][to[1]]);
  RC_ASSERT(path.empty() == (distance == infinity));
  if (path.empty()) return;
  RC_ASSERT(path.back() == to[0] || path.back() == to[1]);
  RC_ASSERT(is_path(graph, path, a, path.back()));
  RC_ASSERT(graph.length(path) == distance);
}

RC_GTEST_PROP(Paths, PassThroughNoDeadEnd, ()) {
  Graph graph = random_graph(3, 9, *rc::gen::inRange(1, 4));
  const int n = graph.size();
  std::vector<char> dead_end(n, 0);
  for (int v = 1; v < n; ++v) dead_end[v] = static_cast<char>(*rc::gen::inRange(0, 2));
  // Without them but for the target, the path is the shortest.
  const int to = *rc::gen::inRange(1, n);
  Graph rest;
  for (std::size_t e = 0; e < graph.edges.size(); ++e) {
    const auto [i, j] = graph.edges[e];
    if ((dead_end[i] && i != to) || (dead_end[j] && j != to)) continue;
    rest.edges.push_back(graph.edges[e]);
    rest.graph.length.push_back(graph.graph.length[e]);
  }
  rest.graph.neighbors = vertex_neighbors(rest.edges, n);
  const double expected = all_distances(rest)[0][to];
  graph.graph.dead_end = dead_end;
  RC_ASSERT(distances(graph.graph, {0})[to] == expected);
  const Path path = shortest_path(graph.graph, 0, {to});
  RC_ASSERT(path.empty() == (expected == infinity));
  for (std::size_t k = 0; k + 1 < path.size(); ++k) RC_ASSERT(!dead_end[path[k]]);
}

TEST(Paths, TheShortestPathToItselfIsTheVertex) {
  EXPECT_EQ(shortest_path(graph_with_lengths(test::octahedron()).graph, 3, {3}), Path{3});
}

// ------------------------------------------------------------------------------------------ disjoint paths

RC_GTEST_PROP(Paths, DisjointPathsAreTheShortestOfAllPairs, ()) {
  const Graph graph = random_graph(3, 7, *rc::gen::inRange(1, 5));
  const std::array<Path, 2> paths = disjoint_paths(graph.graph, 0, {1, 2});
  const double expected = least_disjoint_length(graph, 0, {1, 2});
  RC_ASSERT(paths[0].empty() == (expected == infinity));
  RC_ASSERT(paths[1].empty() == paths[0].empty());
  if (paths[0].empty()) return;
  RC_ASSERT(is_path(graph, paths[0], 0, 1));
  RC_ASSERT(is_path(graph, paths[1], 0, 2));
  RC_ASSERT(share_only_the_first(paths));
  RC_ASSERT(graph.length(paths[0]) + graph.length(paths[1]) == expected);
}

RC_GTEST_PROP(Paths, DisjointPathsAreAsShortWhereBoundsLeadTheSearches, ()) {
  const Graph graph = random_graph(3, 7, *rc::gen::inRange(1, 5));
  std::vector<double> left = distances(graph.graph, {1, 2});
  const double share = *rc::gen::inRange(0, 5) / 4.0;
  for (double& bound : left) bound = bound < infinity ? share * bound : 0;
  const std::array<Path, 2> paths = disjoint_paths(graph.graph, 0, {1, 2}, left);
  const double expected = least_disjoint_length(graph, 0, {1, 2});
  RC_ASSERT(paths[0].empty() == (expected == infinity));
  if (paths[0].empty()) return;
  RC_ASSERT(is_path(graph, paths[0], 0, 1));
  RC_ASSERT(is_path(graph, paths[1], 0, 2));
  RC_ASSERT(share_only_the_first(paths));
  RC_ASSERT(graph.length(paths[0]) + graph.length(paths[1]) == expected);
}

TEST(Paths, AFirstPathThatBlocksTheSecondGivesWay) {
  // The short way from 0 to 1 runs over 3 and 4, and 2 hangs on 4 alone: 0-3-1 and 0-5-4-2 remain.
  Graph graph;
  graph.edges = {{0, 3}, {0, 5}, {1, 3}, {1, 4}, {2, 4}, {3, 4}, {4, 5}};
  graph.graph = {vertex_neighbors(graph.edges, 6), {1, 4, 9, 1, 5, 1, 4}};
  const std::array<Path, 2> paths = disjoint_paths(graph.graph, 0, {1, 2});
  EXPECT_EQ(paths[0], (Path{0, 3, 1}));
  EXPECT_EQ(paths[1], (Path{0, 5, 4, 2}));
}

TEST(Paths, DisjointPathsExistBetweenAllVerticesOfSmallSolids) {
  for (const Mesh& mesh : {test::tetrahedron(), test::octahedron(), test::icosahedron()})
    EXPECT_EQ(without_disjoint_paths(mesh), std::nullopt);
}

TEST(Paths, DisjointPathsExistWhereAllFacesAreSplit) {
  const Mesh once = test::with_all_faces_split(test::tetrahedron());
  EXPECT_EQ(without_disjoint_paths(once), std::nullopt);
  EXPECT_EQ(without_disjoint_paths(test::with_all_faces_split(once)), std::nullopt);
  EXPECT_EQ(without_disjoint_paths(test::with_all_faces_split(test::octahedron())), std::nullopt);
}

RC_GTEST_PROP(Paths, DisjointPathsExistOnEveryTriangulatedSphere, (std::uint32_t seed)) {
  const Graph graph = graph_with_lengths(test::random_sphere(seed, static_cast<int>(seed % 13)));
  RC_ASSERT(has_disjoint_paths(graph, static_cast<int>(seed % graph.size())));
}

TEST(Paths, DisjointPathsDoNotExistThroughOneVertex) {
  // Two fans that share vertex 0 only.
  const std::vector<std::array<int, 2>> edges = {{0, 1}, {0, 2}, {0, 3}, {0, 4}, {1, 2}, {3, 4}};
  const EdgeGraph graph = {vertex_neighbors(edges, 5), std::vector<double>(edges.size(), 1.0)};
  const std::array<Path, 2> paths = disjoint_paths(graph, 1, {3, 4});
  EXPECT_TRUE(paths[0].empty());
  EXPECT_TRUE(paths[1].empty());
}

TEST(Paths, DisjointPathsAreTheSameEveryTime) {
  const Graph graph = graph_with_lengths(test::icosphere(2));
  EXPECT_EQ(disjoint_paths(graph.graph, 0, {5, 11}), disjoint_paths(graph.graph, 0, {5, 11}));
}

}  // namespace
}  // namespace orbitutte::paths_test
