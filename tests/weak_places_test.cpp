// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/weak_places.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <random>

#include "orbitutte/inspect/inspection.h"
#include "polygon_meshes.h"
#include "random_spheres.h"

namespace orbitutte::weak_places_test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<WeakPlace> places_of(const Mesh& mesh) { return find_weak_places(to_polygon_mesh(mesh)); }

void expect_only(const std::vector<WeakPlace>& places, WeakPlaceKind kind, long long count,
                 const std::string& text) {
  ASSERT_EQ(places.size(), 1u);
  EXPECT_EQ(places[0].kind, kind);
  EXPECT_EQ(places[0].count, count);
  EXPECT_THAT(places[0].message, HasSubstr(text));
}

std::vector<int> collapsing(const PolygonMesh& mesh, const std::vector<std::vector<int>>& mirrors,
                            const std::vector<int>& marks) {
  return collapsing_faces(FaceView(mesh.corners, mesh.face_start), mirrors, marks);
}

TEST(WeakPlaces, ThreeConnectedMeshesHaveNone) {
  for (const Mesh& mesh :
       {test::tetrahedron(), test::icosphere(2), test::round_disk(4), test::projective_plane(1)})
    EXPECT_THAT(places_of(mesh), IsEmpty());
  for (const PolygonMesh& mesh :
       {test::cube(), test::prism(3), test::prism(50), test::pyramid(3), test::pyramid(50),
        test::square_grid(5, 4), test::dual(test::icosphere(1)), test::quadrangulated(test::icosphere(1)),
        test::quadrangulated(test::round_disk(3))})
    EXPECT_THAT(find_weak_places(mesh), IsEmpty());
}

TEST(WeakPlaces, InnerVertexOfTwoEdgesIsNamed) {
  const PolygonMesh once = test::with_edge_divided(test::cube(), 0, 1);
  expect_only(find_weak_places(once), WeakPlaceKind::degree_two, 1,
              "vertex 8 has edges only to the vertices");
  const PolygonMesh twice = test::with_edge_divided(once, 0, 8);
  expect_only(find_weak_places(twice), WeakPlaceKind::degree_two, 2, "(2 such places)");
}

TEST(WeakPlaces, EarIsNamed) {
  const Mesh mesh = test::grid_disk(4, 4);  // two corners of the square have a single triangle
  expect_only(places_of(mesh), WeakPlaceKind::ear, 2, "has all edges but (");
}

TEST(WeakPlaces, ChordIsNamed) {
  const std::vector<WeakPlace> places = places_of(test::grid_disk(4, 1));
  ASSERT_EQ(places.size(), 2u);
  EXPECT_EQ(places[0].kind, WeakPlaceKind::ear);
  EXPECT_EQ(places[0].count, 2);
  EXPECT_EQ(places[1].kind, WeakPlaceKind::chord);
  EXPECT_EQ(places[1].count, 5);
}

TEST(WeakPlaces, ChordOfSquaresIsNamed) {
  std::vector<WeakPlace> places = find_weak_places(test::square_grid(4, 1));
  ASSERT_EQ(places.size(), 2u);  // the squares at both ends are ears
  EXPECT_EQ(places[1].kind, WeakPlaceKind::chord);
  EXPECT_EQ(places[1].count, 1);  // the others are edges of ears
  EXPECT_THAT(places[1].message, HasSubstr("edge (2, 7)"));
}

TEST(WeakPlaces, FaceAcrossADiskIsNamed) {
  // Two strips of squares, joined by a hexagon that meets the boundary above and below.
  const PolygonMesh mesh =
      test::polygon_mesh({{0, 0, 0},
                          {1, 0, 0},
                          {0, 1, 0},
                          {1, 1, 0},
                          {0, 2, 0},
                          {1, 2, 0},
                          {2, 0, 0},
                          {3, 0, 0},
                          {2, 1, 0},
                          {3, 1, 0},
                          {2, 2, 0},
                          {3, 2, 0}},
                         {{0, 1, 3, 2}, {2, 3, 5, 4}, {6, 7, 9, 8}, {8, 9, 11, 10}, {1, 6, 8, 10, 5, 3}});
  ASSERT_THAT(inspect(mesh).defects, IsEmpty());
  bool found = false;
  for (const WeakPlace& place : find_weak_places(mesh))
    if (place.kind == WeakPlaceKind::boundary_face) {
      found = true;
      EXPECT_EQ(place.message.find("face 4 meets the boundary in 2 places"), 0u);
    }
  EXPECT_TRUE(found);
}

// A cube of squares, the face 0 of which holds a smaller square that touches two opposite corners.
PolygonMesh with_inset() {
  std::vector<std::vector<int>> faces = test::face_lists(test::cube());
  std::vector<Vector3> points = test::point_list(test::cube().V);
  points.emplace_back(0.4, 0.6, 0);  // 8
  points.emplace_back(0.6, 0.4, 0);  // 9
  points.emplace_back(0.5, 0.5, 0);  // 10
  faces[0] = {0, 3, 2, 8};           // was 0 3 2 1
  faces.insert(faces.end(), {{0, 8, 10}, {8, 2, 10}, {2, 9, 10}, {9, 0, 10}, {0, 9, 2, 1}});
  return test::polygon_mesh(points, faces);
}

TEST(WeakPlaces, FacesThatTouchTwiceAreNamed) {
  const PolygonMesh mesh = with_inset();
  ASSERT_THAT(inspect(mesh).defects, IsEmpty());
  const std::vector<WeakPlace> places = find_weak_places(mesh);
  expect_only(places, WeakPlaceKind::double_contact, 1, "faces 0 and 10 share the vertices");
  EXPECT_THAT(collapsing(mesh, {}, {4, 5, 6}), ElementsAre(6, 7, 8, 9));
  EXPECT_THAT(collapsing(mesh, {}, {4, 5, 10}), IsEmpty());
}

// Do the vertices other than v and w fall apart?
bool separates(const PolygonMesh& mesh, int v, int w) {
  std::vector<std::vector<int>> near(mesh.vertex_count());
  for (const std::vector<int>& face : test::face_lists(mesh)) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      near[face[k]].push_back(face[(k + 1) % face.size()]);
      near[face[(k + 1) % face.size()]].push_back(face[k]);
    }
  }
  std::vector<char> seen(mesh.vertex_count(), 0);
  seen[v] = seen[w] = 1;
  std::vector<int> reached;
  for (int u = 0; u < mesh.vertex_count() && reached.empty(); ++u)
    if (!seen[u]) seen[u] = 1, reached.push_back(u);
  for (std::size_t k = 0; k < reached.size(); ++k)
    for (const int u : near[reached[k]])
      if (!seen[u]) seen[u] = 1, reached.push_back(u);
  return static_cast<int>(reached.size()) + 2 < mesh.vertex_count();
}

/// A triangulation with edges taken away, as the seed decides: faces of all kinds, seldom 3-connected.
PolygonMesh with_edges_removed(const Mesh& mesh, std::uint32_t seed, int removals) {
  std::mt19937 random(seed);
  PolygonMesh result = to_polygon_mesh(mesh);
  for (int k = 0; k < removals; ++k) {
    std::vector<std::vector<int>> faces = test::face_lists(result);
    const int f = static_cast<int>(random() % faces.size());
    std::rotate(faces[f].begin(), faces[f].begin() + static_cast<std::ptrdiff_t>(random() % faces[f].size()),
                faces[f].end());
    const int a = faces[f][0], b = faces[f][1];  // the edge (a, b) goes
    for (int g = 0; g < static_cast<int>(faces.size()); ++g) {
      const auto at = std::find(faces[g].begin(), faces[g].end(), b);
      if (g == f || at == faces[g].end()) continue;
      std::rotate(faces[g].begin(), at, faces[g].end());
      if (faces[g][1] != a) continue;
      faces[f].erase(faces[f].begin());                                       // b ... without a
      faces[f].insert(faces[f].end(), faces[g].begin() + 1, faces[g].end());  // a ...
      faces.erase(faces.begin() + g);
      break;
    }
    const PolygonMesh next = test::polygon_mesh(test::point_list(result.V), faces);
    const Inspection inspection = inspect(next);
    if (inspection.defects.empty() && inspection.unreferenced_vertices == 0) result = next;
  }
  return result;
}

RC_GTEST_PROP(WeakPlaces, ThereAreNoneExactlyWhereNoTwoVerticesSeparateTheMesh, ()) {
  const Mesh sphere = test::random_sphere(*rc::gen::arbitrary<std::uint32_t>(), *rc::gen::inRange(0, 8));
  const PolygonMesh mesh =
      with_edges_removed(sphere, *rc::gen::arbitrary<std::uint32_t>(), *rc::gen::inRange(0, 8));
  bool falls_apart = false;
  for (int v = 0; v < mesh.vertex_count() && !falls_apart; ++v)
    for (int w = 0; w < v && !falls_apart; ++w) falls_apart = separates(mesh, v, w);
  RC_ASSERT(find_weak_places(mesh).empty() == !falls_apart);
}

TEST(CollapsingFaces, EarsAndPartsBehindChordsCollapseOntoOneMirrorOnly) {
  const PolygonMesh mesh = test::square_grid(5, 1);  // below 0 .. 5, above 6 .. 11
  EXPECT_THAT(collapsing(mesh, {{0, 1, 2, 3, 4, 5, 11, 10, 9, 8, 7, 6}}, {}), ElementsAre(0, 1, 2, 3, 4));
  EXPECT_THAT(collapsing(mesh, {{0, 1, 2, 3, 4, 5}, {5, 11, 10, 9}, {9, 8, 7, 6, 0}}, {0, 5, 9}), IsEmpty());
  EXPECT_THAT(collapsing(mesh, {{1, 2, 3, 4, 5, 11, 10, 9, 8}, {8, 7, 6, 0}, {0, 1}}, {0, 1, 8}),
              ElementsAre(2, 3, 4));
}

// The faces at the tip of an ear, whose only face it is.
std::vector<int> faces_at(const Mesh& mesh, const std::vector<int>& tips) {
  std::vector<int> faces;
  for (int f = 0; f < test::face_count(mesh); ++f)
    for (const int v : mesh.F.row(f))
      if (std::find(tips.begin(), tips.end(), v) != tips.end()) faces.push_back(f);
  return faces;
}

TEST(CollapsingFaces, AMirrorThatLeadsAroundToAMarkedCornerBendsThere) {
  const Mesh mesh = test::grid_disk(3, 3);  // 3 and 12 are tips of ears, 5 lies inside
  const std::vector<int> around = {0, 1, 2, 3, 7, 11, 15, 14, 13, 12, 8, 4};
  for (const int corner : around) {
    std::vector<int> mirror = around;
    std::rotate(mirror.begin(), std::find(mirror.begin(), mirror.end(), corner), mirror.end());
    mirror.push_back(corner);
    std::vector<int> tips;
    for (const int tip : {3, 12})
      if (tip != corner) tips.push_back(tip);
    EXPECT_EQ(collapsing_faces(FaceView(mesh.F), {mirror}, {5, corner}), faces_at(mesh, tips)) << corner;
  }
}

}  // namespace
}  // namespace orbitutte::weak_places_test
