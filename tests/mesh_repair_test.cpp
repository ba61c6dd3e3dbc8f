// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/mesh_repair.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <limits>
#include <set>
#include <vector>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/samples/sample.h"

namespace orbitutte::mesh_repair_test {
namespace {

using Faces = std::vector<std::vector<int>>;

PolygonMesh mesh_of(const std::vector<Vector3>& points, const Faces& faces) {
  PolygonMesh mesh;
  mesh.V.resize(static_cast<int>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) mesh.V.row(static_cast<int>(v)) = points[v];
  for (const std::vector<int>& face : faces) {
    mesh.corners.insert(mesh.corners.end(), face.begin(), face.end());
    mesh.face_start.push_back(static_cast<int>(mesh.corners.size()));
  }
  return mesh;
}

PolygonMesh figure() { return to_polygon_mesh(sample_mesh({SampleShape::figure, 500})); }

bool did(const RepairedMesh& repaired, RepairStep step) {
  return std::any_of(repaired.records.begin(), repaired.records.end(),
                     [&](const RepairRecord& record) { return record.step == step && record.count > 0; });
}

Topology topology(const PolygonMesh& mesh) {
  const Inspection inspection = inspect(mesh);
  EXPECT_TRUE(inspection.defects.empty()) << inspection.defects.front().message;
  return inspection.topology;
}

// Every face has corners of its own, as in a file without indices.
PolygonMesh soup(const PolygonMesh& mesh) {
  PolygonMesh result;
  result.V.resize(static_cast<int>(mesh.corners.size()), 3);
  for (std::size_t k = 0; k < mesh.corners.size(); ++k) {
    result.V.row(static_cast<int>(k)) = mesh.V.row(mesh.corners[k]);
    result.corners.push_back(static_cast<int>(k));
  }
  result.face_start = mesh.face_start;
  return result;
}

TEST(MeshRepair, LeavesASoundMeshAsItIs) {
  const PolygonMesh mesh = figure();
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_TRUE(repaired.records.empty());
  EXPECT_EQ(repaired.mesh.V, mesh.V);
  EXPECT_EQ(repaired.mesh.corners, mesh.corners);
  for (int v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(repaired.source_vertex[v], v);
}

TEST(MeshRepair, WeldsASoup) {
  const PolygonMesh mesh = figure();
  const RepairedMesh repaired = repair_mesh(soup(mesh));
  EXPECT_TRUE(did(repaired, RepairStep::weld));
  EXPECT_EQ(repaired.mesh.vertex_count(), mesh.vertex_count());
  EXPECT_EQ(topology(repaired.mesh), Topology::sphere);
}

TEST(MeshRepair, WeldsWithinATolerance) {
  PolygonMesh mesh = soup(figure());
  for (int v = 0; v < mesh.vertex_count(); ++v) mesh.V(v, v % 3) += 1e-7 * (v % 5 - 2);
  MeshRepairOptions options;
  options.weld_tolerance = 1e-6;
  EXPECT_EQ(topology(repair_mesh(mesh, options).mesh), Topology::sphere);
  options.weld_tolerance = -1;
  EXPECT_THROW(repair_mesh(mesh, options), ArgumentError);
}

TEST(MeshRepair, KeepsPositionsOfWhatItKeeps) {
  const PolygonMesh mesh = soup(figure());
  const RepairedMesh repaired = repair_mesh(mesh);
  for (int v = 0; v < repaired.mesh.vertex_count(); ++v)
    EXPECT_EQ(repaired.mesh.V.row(v), mesh.V.row(repaired.source_vertex[v]));
}

RC_GTEST_PROP(MeshRepair, UndoesPlantedFaults, ()) {
  PolygonMesh mesh = figure();
  Faces faces;
  for (int f = 0; f < mesh.face_count(); ++f)
    faces.push_back({mesh.corners[3 * f], mesh.corners[3 * f + 1], mesh.corners[3 * f + 2]});
  const int m = mesh.face_count(), n = mesh.vertex_count();
  const auto some_face = [&] { return *rc::gen::inRange(0, m); };
  const auto turned = *rc::gen::container<std::vector<int>>(5, rc::gen::inRange(0, m));
  for (const int f : turned) std::swap(faces[f][1], faces[f][2]);
  faces.push_back(faces[some_face()]);  // twice
  faces.push_back({0, 0, 1});           // no triangle
  faces.push_back({0, 1, n + 7});       // no vertex
  std::vector<Vector3> points;
  for (int v = 0; v < n; ++v) points.emplace_back(mesh.V.row(v));
  for (int k = 0; k < 3; ++k) points.emplace_back(5, k, k * k);  // a component of its own
  faces.push_back({n, n + 1, n + 2});
  faces.erase(faces.begin() + some_face());  // a hole
  MeshRepairOptions options;
  options.largest_hole = 10;
  const RepairedMesh repaired = repair_mesh(mesh_of(points, faces), options);
  const Inspection inspection = inspect(repaired.mesh);
  RC_ASSERT(inspection.defects.empty());
  RC_ASSERT(inspection.topology == Topology::sphere);
  RC_ASSERT(repaired.mesh.face_count() == m);
  RC_ASSERT(repaired.mesh.vertex_count() == n);
}

TEST(MeshRepair, CutsApartTwoTetrahedraAtAVertexAndAtAnEdge) {
  const std::vector<Vector3> points = {{0, 0, 0},  {1, 0, 0},  {0, 1, 0}, {0, 0, 1},
                                       {-9, 0, 0}, {0, -9, 0}, {0, 0, -9}};
  const Faces tetrahedron = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};
  Faces at_vertex = tetrahedron, at_edge = tetrahedron;
  for (const auto& face : Faces{{0, 4, 5}, {0, 6, 4}, {4, 6, 5}, {5, 6, 0}}) at_vertex.push_back(face);
  for (const auto& face : Faces{{0, 1, 5}, {0, 6, 1}, {1, 6, 5}, {5, 6, 0}}) at_edge.push_back(face);
  for (const Faces& faces : {at_vertex, at_edge}) {
    const RepairedMesh repaired = repair_mesh(mesh_of(points, faces));
    EXPECT_TRUE(did(repaired, RepairStep::split_non_manifold));
    EXPECT_TRUE(did(repaired, RepairStep::keep_largest));
    EXPECT_EQ(topology(repaired.mesh), Topology::sphere);
    EXPECT_EQ(repaired.mesh.face_count(), 4);
    EXPECT_THAT(repaired.source_vertex, testing::Contains(6)) << "the larger one";
  }
}

TEST(MeshRepair, TurnsAnInsideOutMesh) {
  PolygonMesh mesh = figure();
  for (int f = 0; f < mesh.face_count(); ++f) std::swap(mesh.corners[3 * f], mesh.corners[3 * f + 1]);
  const RepairedMesh repaired = repair_mesh(mesh);
  ASSERT_EQ(repaired.records.size(), 1U);
  EXPECT_EQ(repaired.records[0].step, RepairStep::orient);
  EXPECT_EQ(repaired.records[0].count, mesh.face_count());
}

// A grid of n x n squares without some of them.
PolygonMesh grid(int n, const std::set<int>& without) {
  std::vector<Vector3> points;
  for (int i = 0; i <= n; ++i)
    for (int j = 0; j <= n; ++j) points.emplace_back(i, j, 0);
  Faces faces;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      if (without.contains(n * i + j)) continue;
      const int a = i * (n + 1) + j, b = a + n + 1;
      faces.push_back({a, b, b + 1});
      faces.push_back({a, b + 1, a + 1});
    }
  return mesh_of(points, faces);
}

double area(const PolygonMesh& mesh) { return inspect(mesh).area; }

TEST(MeshRepair, FillsAllHolesButTheLongestAndNoMoreThanAsked) {
  const PolygonMesh mesh = grid(6, {7, 8, 21});
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_EQ(topology(repaired.mesh), Topology::disk);
  EXPECT_NEAR(area(repaired.mesh), 36, 1e-12);
  MeshRepairOptions options;
  options.largest_hole = 5;
  EXPECT_NEAR(area(repair_mesh(mesh, options).mesh), 34, 1e-12);
  options.without.push_back(RepairStep::fill_holes);
  EXPECT_NEAR(area(repair_mesh(mesh, options).mesh), 33, 1e-12);
}

TEST(MeshRepair, FillsALongHoleAroundItsMiddle) {
  std::set<int> without;
  for (int i = 2; i < 58; ++i)
    for (int j = 2; j < 58; ++j) without.insert(60 * i + j);
  MeshRepairOptions options;
  options.without.push_back(RepairStep::split_ears);
  const RepairedMesh repaired = repair_mesh(grid(60, without), options);
  EXPECT_EQ(topology(repaired.mesh), Topology::disk);
  EXPECT_NEAR(area(repaired.mesh), 3600, 1e-9);
  EXPECT_EQ(std::count(repaired.source_vertex.begin(), repaired.source_vertex.end(), -1), 1);
}

TEST(MeshRepair, SplitsEarsAndChords) {
  const PolygonMesh mesh = grid(4, {});
  EXPECT_FALSE(find_weak_places(mesh).empty());
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_TRUE(did(repaired, RepairStep::split_ears));
  EXPECT_EQ(topology(repaired.mesh), Topology::disk);
  EXPECT_TRUE(find_weak_places(repaired.mesh).empty());
  EXPECT_NEAR(area(repaired.mesh), 16, 1e-12);
}

TEST(MeshRepair, SplitsATriangleOnAllSides) {
  // A triangle with a triangle at each side: three chords.
  const PolygonMesh mesh = mesh_of({{0, 0, 0}, {2, 0, 0}, {1, 2, 0}, {1, -1, 0}, {3, 2, 0}, {-1, 2, 0}},
                                   {{0, 1, 2}, {1, 0, 3}, {2, 1, 4}, {0, 2, 5}});
  const RepairedMesh repaired = repair_mesh(mesh);
  EXPECT_EQ(repaired.mesh.face_count(), 10);
  EXPECT_EQ(topology(repaired.mesh), Topology::disk);
  EXPECT_TRUE(find_weak_places(repaired.mesh).empty());
  EXPECT_NEAR(area(repaired.mesh), area(mesh), 1e-12);
}

TEST(MeshRepair, DropsWhatIsNotFinite) {
  PolygonMesh mesh = figure();
  mesh.V(7, 1) = std::numeric_limits<double>::quiet_NaN();
  MeshRepairOptions options;
  options.largest_hole = 20;
  const RepairedMesh repaired = repair_mesh(mesh, options);
  EXPECT_TRUE(did(repaired, RepairStep::drop_bad_faces));
  EXPECT_EQ(topology(repaired.mesh), Topology::sphere);
  EXPECT_EQ(repaired.mesh.vertex_count(), mesh.vertex_count() - 1);
}

// The faces as points in space, in order.
std::vector<std::vector<Vector3>> faces_in_space(const PolygonMesh& mesh) {
  std::vector<std::vector<Vector3>> faces(mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f)
    for (int k = mesh.face_start[f]; k < mesh.face_start[f + 1]; ++k)
      faces[f].emplace_back(mesh.V.row(mesh.corners[k]));
  return faces;
}

RC_GTEST_PROP(RepairInPlace, IsTheSameRepairAndVerticesKeepTheirNumbers, ()) {
  PolygonMesh mesh = soup(grid(5, {7, 12}));
  const auto turned = *rc::gen::container<std::vector<int>>(4, rc::gen::inRange(0, mesh.face_count()));
  for (const int f : turned) std::swap(mesh.corners[3 * f], mesh.corners[3 * f + 1]);
  const RepairedMesh repaired = repair_mesh(mesh);
  const RepairInPlace in_place = repair_in_place(mesh);
  const int n = mesh.vertex_count();
  RC_ASSERT(faces_in_space(in_place.mesh) == faces_in_space(repaired.mesh));
  RC_ASSERT(in_place.mesh.vertex_count() == n + static_cast<int>(in_place.summary.added.size()));
  for (const int v : in_place.mesh.corners) {
    if (v < n) RC_ASSERT(in_place.mesh.V.row(v) == mesh.V.row(v));
    if (v < n) RC_ASSERT(in_place.image[v] == v);
  }
  for (int v = 0; v < n; ++v) {
    const int became = in_place.image[v];
    if (became >= 0) RC_ASSERT(in_place.mesh.V.row(became) == mesh.V.row(v));
  }
  RC_ASSERT(inspect(in_place.mesh).topology == Topology::disk);
}

TEST(RepairInPlace, SaysWhatBecameOfEachVertex) {
  // Two triangles beside each other that are not welded, one far away, and a vertex without a face.
  const PolygonMesh mesh = mesh_of({{0, 0, 0},
                                    {4, 0, 0},
                                    {0, 4, 0},
                                    {4, 0, 0},
                                    {4, 4, 0},
                                    {0, 4, 0},
                                    {9, 9, 9},
                                    {9, 8, 9},
                                    {8, 9, 9},
                                    {0, 0, std::numeric_limits<double>::infinity()}},
                                   {{0, 1, 2}, {3, 4, 5}, {6, 7, 8}});
  const RepairInPlace repaired = repair_in_place(mesh);
  EXPECT_THAT(repaired.image, testing::ElementsAre(0, 1, 2, 1, 4, 2, -1, -1, -1, -1));
  EXPECT_THAT(repaired.summary.added, testing::ElementsAre(-1)) << "in the middle of the edge inside";
  EXPECT_TRUE(repaired.mesh.V.allFinite());
  EXPECT_EQ(topology(repaired.mesh), Topology::disk);
}

TEST(RepairInPlace, NamesTheVerticesOfCopies) {
  const PolygonMesh mesh =
      mesh_of({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {{0, 1, 2}, {0, 3, 4}});
  MeshRepairOptions options;
  options.without = {RepairStep::keep_largest, RepairStep::fill_holes};
  const RepairInPlace repaired = repair_in_place(mesh, options);
  EXPECT_THAT(repaired.summary.added, testing::ElementsAre(0));
  EXPECT_EQ(repaired.image[0], 0);
}

TEST(MeshRepair, LeavesOutStepsWithoutLookingAtBadFaces) {
  PolygonMesh mesh = figure();
  mesh.corners[3] = mesh.vertex_count() + 5;
  MeshRepairOptions options;
  options.without = {RepairStep::drop_bad_faces, RepairStep::keep_largest};
  const RepairedMesh repaired = repair_mesh(mesh, options);
  EXPECT_EQ(repaired.mesh.corners[3], mesh.vertex_count() + 5) << "it is there still, for inspect to name";
}

}  // namespace
}  // namespace orbitutte::mesh_repair_test
