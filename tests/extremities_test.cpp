// SPDX-License-Identifier: MIT
#include "orbitutte/cones/extremities.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "random_spheres.h"

namespace orbitutte::extremities_test {
namespace {

using test::vertex_count;

/// On the boundary, or anywhere where there is none.
std::vector<int> extremities_of(const Mesh& mesh, int count) {
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  const std::vector<int>& opposite = connectivity.opposite;
  const bool closed = std::find(opposite.begin(), opposite.end(), -1) == opposite.end();
  return choose_extremities(test::unjudged(mesh), {closed ? count : 0, closed ? 0 : count});
}

EdgeGraph graph_of(const Mesh& mesh) { return edge_length_graph(test::unjudged(mesh)); }

std::vector<int> all_vertices(const Mesh& mesh) { return test::permutation(vertex_count(mesh), 0); }

std::vector<int> boundary_vertices(const Mesh& mesh) {
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  std::set<int> result;
  for (int h = 0; h < mesh.F.size(); ++h)
    if (connectivity.opposite[h] < 0) result.insert(halfedge_origin(mesh.F, h));
  return {result.begin(), result.end()};
}

/// The least distance between two of the vertices.
double separation(const EdgeGraph& graph, const std::vector<int>& vertices) {
  double least = std::numeric_limits<double>::infinity();
  for (const int v : vertices) {
    const std::vector<double> d = distances(graph, {v});
    for (const int w : vertices)
      if (v != w) least = std::min(least, d[w]);
  }
  return least;
}

/// The largest separation that any three vertices among these have.
double best_separation_of_three(const EdgeGraph& graph, const std::vector<int>& among) {
  std::vector<std::vector<double>> d;
  for (const int v : among) d.push_back(distances(graph, {v}));
  double best = 0;
  for (std::size_t i = 0; i < among.size(); ++i)
    for (std::size_t j = 0; j < i; ++j)
      for (std::size_t k = 0; k < j; ++k)
        best = std::max(best, std::min({d[i][among[j]], d[i][among[k]], d[j][among[k]]}));
  return best;
}

TEST(Extremities, EachIsFarthestFromThoseBefore) {
  for (const Mesh& mesh : {test::icosphere(2), test::perturbed(test::octasphere(2), 0.05, 1)}) {
    const EdgeGraph graph = graph_of(mesh);
    const std::vector<int> chosen = extremities_of(mesh, 6);
    for (std::size_t k = 1; k < chosen.size(); ++k) {
      const std::vector<double> d = distances(graph, {chosen.begin(), chosen.begin() + k});
      EXPECT_EQ(d[chosen[k]], *std::max_element(d.begin(), d.end()));
    }
  }
}

TEST(Extremities, AreAtLeastHalfAsSeparatedAsAnyVertices) {
  for (const Mesh& mesh : {test::icosphere(1), test::perturbed(test::octasphere(1), 0.2, 2)}) {
    const EdgeGraph graph = graph_of(mesh);
    EXPECT_GE(2 * separation(graph, extremities_of(mesh, 3)),
              best_separation_of_three(graph, all_vertices(mesh)));
  }
  for (const Mesh& mesh : {test::grid_disk(7, 3), test::round_disk(4)}) {
    const EdgeGraph graph = graph_of(mesh);
    EXPECT_GE(2 * separation(graph, extremities_of(mesh, 3)),
              best_separation_of_three(graph, boundary_vertices(mesh)));
  }
}

TEST(Extremities, OfADiskAreOnItsBoundary) {
  for (const Mesh& mesh : {test::grid_disk(6, 4), test::round_disk(5)}) {
    const std::vector<int> boundary = boundary_vertices(mesh);
    for (const int count : {1, 2, 3, 8}) {
      for (const int v : extremities_of(mesh, count))
        EXPECT_TRUE(std::binary_search(boundary.begin(), boundary.end(), v)) << v;
    }
  }
}

TEST(Extremities, OfADiskStandInAnOrderInWhichItsBoundaryMeetsThem) {
  const Mesh mesh = test::round_disk(3);  // its boundary is 19, 20, ..., 36
  const std::vector<int> first = extremities_of(mesh, 3);
  for (const int count : {4, 5, 8}) {
    const std::vector<int> marks = extremities_of(mesh, count);
    EXPECT_EQ(std::set<int>(marks.begin(), marks.end()).size(), static_cast<std::size_t>(count));
    EXPECT_EQ(marks.front(), first.front());
    std::vector<int> places;  // from the first, in either direction
    for (const int v : marks) places.push_back((v - marks.front() + 18) % 18);
    if (places[1] > places[2])
      std::transform(places.begin() + 1, places.end(), places.begin() + 1, [](int k) { return 18 - k; });
    EXPECT_TRUE(std::is_sorted(places.begin(), places.end())) << testing::PrintToString(marks);
  }
}

TEST(Extremities, InsideADiskAreFarFromItsBoundary) {
  for (const Mesh& mesh : {test::grid_disk(6, 4), test::round_disk(5)}) {
    const std::vector<int> chosen = choose_extremities(test::unjudged(mesh), {1, 1});
    ASSERT_EQ(chosen.size(), 2u);
    const std::vector<double> from_boundary = distances(graph_of(mesh), boundary_vertices(mesh));
    EXPECT_EQ(from_boundary[chosen[0]], *std::max_element(from_boundary.begin(), from_boundary.end()));
    EXPECT_EQ(from_boundary[chosen[1]], 0);
  }
}

TEST(Extremities, OfALongStripAreAtItsEnds) {
  const std::vector<int> chosen = extremities_of(test::grid_disk(20, 1), 2);
  EXPECT_EQ(std::abs(chosen[0] % 21 - chosen[1] % 21), 20);
}

TEST(Extremities, FewerAreTheFirstOfMore) {
  const Mesh mesh = test::icosphere(2);
  const std::vector<int> many = extremities_of(mesh, 10);
  for (int count = 1; count < 10; ++count)
    EXPECT_EQ(extremities_of(mesh, count), std::vector<int>(many.begin(), many.begin() + count));
}

TEST(Extremities, AreTheSameEveryTime) {
  const Mesh mesh = test::round_disk(6);
  EXPECT_EQ(extremities_of(mesh, 5), extremities_of(mesh, 5));
}

RC_GTEST_PROP(Extremities, AreDifferentVerticesThatCanBeMarked, (std::uint32_t seed)) {
  const Mesh mesh = test::random_sphere(seed, static_cast<int>(seed % 11));
  const std::vector<int> chosen = extremities_of(mesh, 3);
  RC_ASSERT(std::set<int>(chosen.begin(), chosen.end()).size() == 3u);
  cut_to_disk(test::unjudged(mesh), chosen, 3);  // throws where they cannot
}

TEST(Extremities, ExistWhereAllPositionsAreTheSame) {
  Mesh mesh = test::icosahedron();
  mesh.V.setConstant(7);
  const std::vector<int> chosen = extremities_of(mesh, 12);
  EXPECT_EQ(std::set<int>(chosen.begin(), chosen.end()).size(), 12u);
}

TEST(Extremities, AreNoVerticesWithoutFaces) {
  Mesh mesh = test::octahedron();
  mesh.V.conservativeResize(8, 3);
  mesh.V.bottomRows(2).setConstant(1000);
  for (const int v : extremities_of(mesh, 6)) EXPECT_LT(v, 6);
}

TEST(Extremities, TooFewVerticesAreRefused) {
  const auto refusal = [](const Mesh& mesh, int count) -> std::string {
    try {
      extremities_of(mesh, count);
      return {};
    } catch (const MeshError& error) {
      return error.what();
    }
  };
  EXPECT_EQ(refusal(test::tetrahedron(), 4), "");
  EXPECT_EQ(refusal(test::tetrahedron(), 5), "5 vertices have to be marked, but only 4 can be");
  EXPECT_THROW(choose_extremities(test::unjudged(test::grid_disk(5, 1)), {1, 0}), MeshError);
  EXPECT_EQ(refusal(test::round_disk(1), 6), "");
  EXPECT_EQ(refusal(test::round_disk(1), 7), "7 vertices have to be marked, but only 6 can be");
}

TEST(Extremities, AreNoNeighboursWhereThatIsAskedForAndPossible) {
  const auto are_joined = [](const Connectivity& connectivity, const std::vector<int>& pair) {
    const std::array<int, 2> edge = {std::min(pair[0], pair[1]), std::max(pair[0], pair[1])};
    return std::binary_search(connectivity.edges.begin(), connectivity.edges.end(), edge);
  };
  Mesh needle = test::octahedron();  // 0 and 1 are opposite, and so are 2, 3 and 4, 5
  for (const int far : {0, 2, 4}) {
    Mesh mesh = needle;
    mesh.V.row(far) *= 10;
    const Connectivity connectivity = connectivity_of(mesh.F, 6);
    EXPECT_FALSE(are_joined(connectivity, choose_extremities(test::unjudged(mesh), {2, 0, true})));
  }
  const Mesh tetrahedron = test::tetrahedron();  // all are neighbours
  EXPECT_EQ(choose_extremities(test::unjudged(tetrahedron), {2, 0, true}).size(), 2u);
  const Mesh disk = test::round_disk(3);
  const Connectivity of_disk = connectivity_of(disk.F, vertex_count(disk));
  EXPECT_FALSE(are_joined(of_disk, choose_extremities(test::unjudged(disk), {0, 2, true})));
}

}  // namespace
}  // namespace orbitutte::extremities_test
