// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/connectivity.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "test_meshes.h"

namespace orbitutte::connectivity_test {
namespace {

using test::face_count;
using test::vertex_count;

struct Example {
  Mesh mesh;
  int euler_characteristic;
  bool closed;
  bool orientable;
};

std::vector<Example> examples() {
  return {{test::tetrahedron(), 2, true, true},
          {test::octahedron(), 2, true, true},
          {test::icosphere(2), 2, true, true},
          {test::grid_disk(1, 1), 1, false, true},
          {test::grid_disk(5, 3), 1, false, true},
          {test::round_disk(4), 1, false, true},
          {test::annulus(7), 0, false, true},
          {test::moebius_strip(6), 0, false, false},
          {test::torus(5, 4), 0, true, true},
          {test::klein_bottle(5, 4), 0, true, false},
          {test::projective_plane(1), 1, true, false},
          {test::united(test::octahedron(), test::round_disk(2)), 3, false, true}};
}

int edge_count(const Connectivity& connectivity) { return static_cast<int>(connectivity.edges.size()); }

TEST(Connectivity, NextAndPreviousGoAroundTheFace) {
  const Mesh mesh = test::icosahedron();
  for (int h = 0; h < mesh.F.size(); ++h) {
    EXPECT_EQ(next_halfedge(h) / 3, h / 3);
    EXPECT_EQ(previous_halfedge(next_halfedge(h)), h);
    EXPECT_EQ(next_halfedge(next_halfedge(next_halfedge(h))), h);
    EXPECT_EQ(halfedge_target(mesh.F, h), halfedge_origin(mesh.F, next_halfedge(h)));
    EXPECT_EQ(halfedge_origin(mesh.F, h), mesh.F(h / 3, h % 3));
  }
}

TEST(Connectivity, OppositeOfTheOppositeIsTheHalfEdgeItself) {
  for (const Example& example : examples()) {
    const Connectivity connectivity = test::edges_of(example.mesh);
    const Triangles& F = example.mesh.F;
    for (int h = 0; h < F.size(); ++h) {
      const int o = connectivity.opposite[h];
      if (o < 0) continue;
      EXPECT_NE(o, h);
      EXPECT_EQ(connectivity.opposite[o], h);
      EXPECT_EQ(connectivity.edge_of[o], connectivity.edge_of[h]);
      if (example.orientable) {
        EXPECT_EQ(halfedge_origin(F, o), halfedge_target(F, h));
        EXPECT_EQ(halfedge_target(F, o), halfedge_origin(F, h));
      }
    }
  }
}

TEST(Connectivity, OnlyBoundaryHalfEdgesHaveNoOpposite) {
  for (const Example& example : examples()) {
    const Connectivity connectivity = test::edges_of(example.mesh);
    std::vector<int> uses(connectivity.edges.size(), 0);
    for (const int e : connectivity.edge_of) ++uses[e];
    int boundary = 0;
    for (int h = 0; h < example.mesh.F.size(); ++h) {
      EXPECT_EQ(connectivity.opposite[h] < 0, uses[connectivity.edge_of[h]] == 1);
      boundary += connectivity.opposite[h] < 0;
    }
    EXPECT_EQ(boundary == 0, example.closed);
    EXPECT_EQ(2 * edge_count(connectivity), 3 * face_count(example.mesh) + boundary);
  }
}

TEST(Connectivity, VerticesLessEdgesPlusFacesIsTheEulerCharacteristic) {
  for (const Example& example : examples()) {
    EXPECT_EQ(
        vertex_count(example.mesh) - edge_count(test::edges_of(example.mesh)) + face_count(example.mesh),
        example.euler_characteristic);
  }
}

TEST(Connectivity, EdgesAreThePairsThatFacesJoinInLexicographicOrder) {
  for (const Example& example : examples()) {
    const Connectivity connectivity = test::edges_of(example.mesh);
    std::set<std::array<int, 2>> expected;
    for (int h = 0; h < example.mesh.F.size(); ++h) {
      const auto [i, j] =
          std::minmax({halfedge_origin(example.mesh.F, h), halfedge_target(example.mesh.F, h)});
      expected.insert({i, j});
      EXPECT_EQ(connectivity.edges[connectivity.edge_of[h]], (std::array<int, 2>{i, j}));
    }
    EXPECT_EQ(connectivity.edges, std::vector(expected.begin(), expected.end()));
  }
}

TEST(Connectivity, NeighborsAreBothEndsOfEveryEdge) {
  for (const Example& example : examples()) {
    const Connectivity connectivity = test::edges_of(example.mesh);
    const int n = vertex_count(example.mesh);
    const Neighbors around = vertex_neighbors(connectivity.edges, n);
    ASSERT_EQ(static_cast<int>(around.start.size()), n + 1);
    EXPECT_EQ(around.start.front(), 0);
    EXPECT_EQ(around.start.back(), 2 * edge_count(connectivity));
    std::set<std::pair<int, int>> seen;
    for (int v = 0; v < n; ++v) {
      for (int k = around.start[v]; k < around.start[v + 1]; ++k) {
        const int w = around.neighbor[k];
        EXPECT_TRUE(seen.emplace(v, w).second);
        EXPECT_EQ(connectivity.edges[around.edge[k]], (std::array<int, 2>{std::min(v, w), std::max(v, w)}));
      }
    }
    EXPECT_EQ(seen.size(), 2 * connectivity.edges.size());
  }
}

TEST(Connectivity, VerticesWithoutFacesHaveNoNeighbors) {
  const Mesh mesh = test::octahedron();
  const Connectivity connectivity = connectivity_of(mesh.F, 9);
  const Neighbors around = vertex_neighbors(connectivity.edges, 9);
  EXPECT_EQ(edge_count(connectivity), 12);
  for (int v = 6; v < 9; ++v) EXPECT_EQ(around.start[v], around.start[v + 1]);
}

TEST(Surface, AreasAtVerticesAddUpToItsArea) {
  const Surface surface = test::unjudged(test::perturbed(test::icosphere(2), 0.03, 7));
  double area = 0;
  for (int f = 0; f < surface.triangle_count(); ++f) area += surface.area(f);
  EXPECT_NEAR(surface.vertex_areas().sum(), area, 1e-12 * area);
  EXPECT_GT(surface.vertex_areas().minCoeff(), 0);
}

TEST(Surface, NormalsOfASphereAreItsPoints) {
  const Mesh sphere = test::icosphere(3);
  const Points normals = vertex_normals(sphere.V, sphere.F);
  EXPECT_LT((normals - sphere.V).rowwise().norm().maxCoeff(), 0.02);
  EXPECT_LT((normals.rowwise().norm().array() - 1).abs().maxCoeff(), 1e-14);
  EXPECT_EQ(vertex_normals(Points::Zero(1, 3), Triangles(0, 3)).row(0), Eigen::RowVector3d(0, 0, 1));
}

TEST(Connectivity, OfNoFacesIsEmpty) {
  const Connectivity connectivity = connectivity_of(Triangles(0, 3), 0);
  EXPECT_TRUE(connectivity.edges.empty());
  EXPECT_TRUE(connectivity.edge_of.empty());
  EXPECT_TRUE(connectivity.opposite.empty());
  EXPECT_EQ(vertex_neighbors(connectivity.edges, 0).start, std::vector<int>{0});
}

RC_GTEST_PROP(Connectivity, DoesNotDependOnTheNumbersOfVerticesAndFaces, (std::uint32_t seed)) {
  const Mesh mesh = test::grid_disk(3, 3);
  const std::vector<int> number = test::permutation(vertex_count(mesh), seed);
  const std::vector<int> old_face = test::permutation(face_count(mesh), seed + 1);
  const Connectivity before = test::edges_of(mesh);
  const Connectivity after = test::edges_of(test::reordered(test::relabelled(mesh, number), old_face));
  std::set<std::array<int, 2>> expected;
  for (const auto& [i, j] : before.edges)
    expected.insert({std::min(number[i], number[j]), std::max(number[i], number[j])});
  RC_ASSERT(after.edges == std::vector(expected.begin(), expected.end()));
  for (int h = 0; h < mesh.F.size(); ++h) {
    const int o = after.opposite[h], old = 3 * old_face[h / 3] + h % 3;
    const int image = o < 0 ? -1 : 3 * old_face[o / 3] + o % 3;
    RC_ASSERT(before.opposite[old] == image);
  }
}

}  // namespace
}  // namespace orbitutte::connectivity_test
