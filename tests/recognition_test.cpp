// SPDX-License-Identifier: MIT
// The quick look at a mesh accepts exactly the spheres and disks in which the thorough one finds no defect.
#include "orbitutte/inspect/recognition.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <limits>

#include "orbitutte/inspect/inspection.h"
#include "polygon_meshes.h"
#include "random_spheres.h"
#include "test_meshes.h"

namespace orbitutte::recognition_test {
namespace {

using test::face_count;
using test::vertex_count;

void expect_agreement(const Mesh& mesh) {
  const Inspection thorough = inspect(mesh);
  const std::optional<Surface> quick = recognize_sphere_or_disk(Mesh(mesh));
  const bool sound = thorough.topology == Topology::sphere || thorough.topology == Topology::disk;
  ASSERT_EQ(quick.has_value(), sound && thorough.defects.empty());
  if (!quick) return;
  EXPECT_EQ(quick->topology, thorough.topology);
  EXPECT_EQ(quick->unreferenced_vertices, thorough.unreferenced_vertices);
  EXPECT_EQ(quick->zero_area_faces, thorough.zero_area_faces);
  EXPECT_EQ(static_cast<int>(quick->connectivity.edges.size()), thorough.edges);
}

Mesh spheres() { return test::united(test::icosphere(1), test::icosphere(2)); }

// Two components with the Euler characteristic of one sphere, which share vertices but no edge.
Mesh spheres_that_touch_twice() {
  return test::with_vertices_merged(test::with_vertices_merged(spheres(), 0, 60), 30, 100);
}

class Recognition : public testing::TestWithParam<Mesh> {};
INSTANTIATE_TEST_SUITE_P(
    Meshes, Recognition,
    testing::Values(
        Mesh(), test::tetrahedron(), test::icosphere(3), test::grid_disk(1, 1), test::grid_disk(5, 4),
        test::round_disk(4), test::annulus(6), test::moebius_strip(7), test::torus(8, 5),
        test::klein_bottle(8, 6), test::projective_plane(2),
        test::united(test::icosphere(1), test::icosphere(2)),
        test::with_vertices_merged(test::icosphere(2), 0, 50), test::with_vertices_merged(spheres(), 0, 60),
        spheres_that_touch_twice(), test::with_face_turned(test::icosphere(2), 17),
        test::with_face(test::icosphere(1), 0, 1, 30), test::with_face(test::grid_disk(3, 3), 0, 1, 99),
        test::with_face(test::grid_disk(3, 3), 0, 0, 5), test::with_face(test::grid_disk(3, 3), 0, -1, 5),
        test::without_faces(test::icosphere(2), {3}), test::without_faces(test::icosphere(2), {3, 100})));

TEST_P(Recognition, AgreesWithInspection) { expect_agreement(GetParam()); }

TEST(Recognition, OneTriangleIsADiskAndTwoOnTheSameVerticesAreADefect) {
  Mesh triangle = {Points::Identity(3, 3), Triangles(1, 3)};
  triangle.F << 0, 1, 2;
  expect_agreement(triangle);
  EXPECT_TRUE(recognize_sphere_or_disk(Mesh(triangle)).has_value());
  const Mesh pillow = test::with_face(triangle, 2, 1, 0);
  expect_agreement(pillow);
  EXPECT_FALSE(recognize_sphere_or_disk(Mesh(pillow)).has_value());
}

TEST(Recognition, CountsUnreferencedVerticesAndZeroAreaFaces) {
  Mesh mesh = test::icosphere(2);
  mesh.V.conservativeResize(mesh.V.rows() + 3, 3);
  mesh.V.bottomRows(3).setOnes();
  mesh.V.row(mesh.F(5, 0)) = 0.5 * (mesh.V.row(mesh.F(5, 1)) + mesh.V.row(mesh.F(5, 2)));
  expect_agreement(mesh);
  const std::optional<Surface> surface = recognize_sphere_or_disk(Mesh(mesh));
  ASSERT_TRUE(surface.has_value());
  EXPECT_EQ(surface->unreferenced_vertices, 3);
  EXPECT_EQ(surface->zero_area_faces, 1);
}

TEST(Recognition, SeesCoordinatesThatAreNotFinite) {
  Mesh mesh = test::icosphere(2);
  mesh.V(7, 1) = std::numeric_limits<double>::quiet_NaN();
  expect_agreement(mesh);
}

// --- surfaces

TEST(Surface, TakesOverTheMemoryOfItsMesh) {
  Mesh mesh = test::icosphere(2);
  const double* const positions = mesh.V.data();
  const int* const faces = mesh.F.data();
  const Surface surface = make_surface(std::move(mesh));
  EXPECT_EQ(surface.V.data(), positions);
  EXPECT_EQ(surface.triangles.data(), faces);
}

TEST(Surface, LeavesAMeshWithADefectAsItWas) {
  const Mesh torus = test::torus(8, 5);
  Mesh mesh = torus;
  EXPECT_THROW(make_surface(std::move(mesh)), MeshError);
  EXPECT_EQ(mesh.V, torus.V);  // NOLINT(bugprone-use-after-move): that is the point
  EXPECT_EQ(mesh.F, torus.F);
}

TEST(Surface, OfAProjectivePlaneIsFound) {
  EXPECT_EQ(make_surface(test::projective_plane(2)).topology, Topology::projective_plane);
}

TEST(Surface, OfPolygonsHasTheirEdgesAndTriangles) {
  const PolygonMesh mesh = test::dual(test::icosphere(1));
  const Surface surface = make_surface(mesh);
  const Inspection inspection = inspect(mesh);
  EXPECT_EQ(surface.topology, inspection.topology);
  EXPECT_EQ(static_cast<int>(surface.connectivity.edges.size()), inspection.edges);
  EXPECT_EQ(surface.triangles, triangles_on_vertices(surface.division, mesh.corners));
  ASSERT_TRUE(surface.has_polygons());
  EXPECT_EQ(surface.faces().count(), mesh.face_count());
  for (int f = 0; f < mesh.face_count(); ++f) EXPECT_EQ(surface.faces().degree(f), mesh.face_degree(f));
  EXPECT_EQ(surface.polygons_on(surface.triangles).corners, mesh.corners);
}

TEST(Surface, OfTrianglesGivenAsPolygonsHasNoPolygonsButTheColours) {
  const Mesh mesh = test::icosphere(1);
  PolygonMesh polygons = to_polygon_mesh(mesh);
  polygons.colours = Points::Constant(mesh.V.rows(), 3, 0.5);
  const Surface surface = make_surface(polygons);
  EXPECT_FALSE(surface.has_polygons());
  EXPECT_EQ(surface.triangles, mesh.F);
  EXPECT_EQ(surface.colours, polygons.colours);
  EXPECT_EQ(surface.polygons_on(surface.triangles).count(), 0);
}

// Spheres with a few of their corners sent elsewhere, faces turned and faces taken out.
RC_GTEST_PROP(Recognition, AgreesWithInspectionOnDamagedSpheres, ()) {
  Mesh mesh = test::random_sphere(*rc::gen::arbitrary<std::uint32_t>(), *rc::gen::inRange(0, 40));
  for (int damages = *rc::gen::inRange(0, 4); damages > 0; --damages) {
    const int f = *rc::gen::inRange(0, face_count(mesh));
    switch (*rc::gen::inRange(0, 4)) {
      case 0:
        mesh = test::with_face_turned(mesh, f);
        break;
      case 1:
        if (face_count(mesh) > 1) mesh = test::without_faces(mesh, {f});
        break;
      case 2:
        mesh.F(f, 0) = *rc::gen::inRange(-1, vertex_count(mesh) + 1);
        break;
      default:
        mesh = test::with_face(mesh, mesh.F(f, 0), mesh.F(f, 1), *rc::gen::inRange(0, vertex_count(mesh)));
    }
  }
  expect_agreement(mesh);
}

}  // namespace
}  // namespace orbitutte::recognition_test
