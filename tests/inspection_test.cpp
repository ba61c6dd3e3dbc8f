// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/inspection.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <ostream>
#include <string>
#include <vector>

#include "orbitutte/io/mesh_io.h"
#include "polygon_meshes.h"
#include "test_meshes.h"

namespace orbitutte::inspection_test {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

std::vector<DefectKind> kinds(const Inspection& inspection) {
  std::vector<DefectKind> result;
  for (const Defect& defect : inspection.defects) result.push_back(defect.kind);
  return result;
}

std::string message(const Inspection& inspection, DefectKind kind) {
  for (const Defect& defect : inspection.defects) {
    if (defect.kind == kind) return defect.message;
  }
  return "no such defect";
}

const Defect& only_defect(const Inspection& inspection) {
  static const Defect none = {DefectKind::empty_mesh, "not one defect", 0};
  EXPECT_EQ(inspection.defects.size(), 1u);
  return inspection.defects.size() == 1 ? inspection.defects.front() : none;
}

void expect_only(const Inspection& inspection, DefectKind kind, long long count,
                 const std::string& sentence) {
  const Defect& defect = only_defect(inspection);
  EXPECT_EQ(defect.kind, kind);
  EXPECT_EQ(defect.count, count);
  EXPECT_EQ(defect.message, sentence);
  EXPECT_EQ(inspection.topology, Topology::other);
}

// ------------------------------------------------------------------------------------------------ sound
// meshes

TEST(Inspection, SpheresHaveEulerCharacteristicTwoAndNoBoundary) {
  for (const Mesh& mesh : {test::tetrahedron(), test::octahedron(), test::icosphere(0), test::icosphere(2),
                           test::octasphere(3)}) {
    const Inspection result = inspect(mesh);
    EXPECT_THAT(kinds(result), IsEmpty());
    EXPECT_EQ(result.topology, Topology::sphere);
    EXPECT_EQ(result.euler_characteristic, 2);
    EXPECT_EQ(result.genus, 0);
    EXPECT_EQ(result.components, 1);
    EXPECT_EQ(2 * result.edges, 3 * result.faces);
    EXPECT_THAT(result.boundary, IsEmpty());
    EXPECT_NO_THROW(require_embeddable(result));
  }
}

TEST(Inspection, TheBoundaryOfADiskRunsAlongItsFaces) {
  const Inspection result = inspect(test::grid_disk(2, 1));
  EXPECT_THAT(kinds(result), IsEmpty());
  EXPECT_EQ(result.topology, Topology::disk);
  EXPECT_EQ(result.euler_characteristic, 1);
  EXPECT_THAT(result.boundary, ElementsAre(ElementsAre(0, 1, 2, 5, 4, 3)));
}

TEST(Inspection, OneTriangleIsADisk) {
  const Inspection result = inspect(test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}));
  EXPECT_THAT(kinds(result), IsEmpty());
  EXPECT_EQ(result.topology, Topology::disk);
  EXPECT_EQ(result.edges, 3);
}

TEST(Inspection, TheProjectivePlaneIsNoDefect) {
  for (int levels = 0; levels < 3; ++levels) {
    const Inspection result = inspect(test::projective_plane(levels));
    EXPECT_THAT(kinds(result), IsEmpty());
    EXPECT_EQ(result.topology, Topology::projective_plane);
    EXPECT_EQ(result.euler_characteristic, 1);
    EXPECT_EQ(result.faces, 10 << (2 * levels));
    EXPECT_FALSE(result.orientable);
    EXPECT_EQ(result.genus, 0);
  }
}

TEST(Inspection, PolygonsAreSurfacesToo) {
  const Inspection result = inspect(test::cube());
  EXPECT_THAT(kinds(result), IsEmpty());
  EXPECT_EQ(result.topology, Topology::sphere);
  EXPECT_EQ(result.triangles, 0);
  EXPECT_EQ(result.max_face_degree, 4);
  EXPECT_EQ(result.edges, 12);
}

TEST(Inspection, UnreferencedVerticesAreCountedAndNoDefect) {
  Mesh mesh = test::united(test::octahedron(), test::octahedron());
  mesh.F.conservativeResize(8, 3);
  const Inspection result = inspect(mesh);
  EXPECT_THAT(kinds(result), IsEmpty());
  EXPECT_EQ(result.topology, Topology::sphere);
  EXPECT_EQ(result.vertices, 12);
  EXPECT_EQ(result.unreferenced_vertices, 6);
}

// ------------------------------------------------------------------------------------------------ planted
// defects

TEST(InspectionDefect, EmptyMeshesSayWhatIsMissing) {
  expect_only(inspect(Mesh()), DefectKind::empty_mesh, 1,
              "the mesh has no vertices and no faces; give a mesh that has both");
  expect_only(inspect(test::mesh({{0, 0, 0}}, {})), DefectKind::empty_mesh, 1,
              "the mesh has no faces; give a mesh that has both");
  expect_only(inspect(test::mesh({}, {{0, 1, 2}})), DefectKind::empty_mesh, 1,
              "the mesh has no vertices; give a mesh that has both");
}

TEST(InspectionDefect, IndicesOutOfRangeNameTheFaceAndTheVertex) {
  Mesh mesh = test::octahedron();
  mesh.F(5, 1) = 6;
  mesh.F(7, 0) = -1;
  const Inspection result = inspect(mesh);
  expect_only(result, DefectKind::index_out_of_range, 2,
              "face 5 names vertex 6, but the vertices are numbered from 0 to 5 (2 such faces); correct or "
              "remove the face");
  EXPECT_EQ(result.euler_characteristic, 0);
  EXPECT_THAT(result.boundary, IsEmpty());
}

TEST(InspectionDefect, PositionsThatAreNotFiniteNameTheVertexAndLeaveTheQualityOut) {
  Mesh mesh = test::octahedron();
  mesh.V(3, 1) = std::numeric_limits<double>::quiet_NaN();
  mesh.V(4, 0) = std::numeric_limits<double>::infinity();
  const Inspection result = inspect(mesh);
  expect_only(result, DefectKind::non_finite_position, 2,
              "vertex 3 is at (0, nan, 0) (2 such vertices); give it finite coordinates");
  EXPECT_EQ(result.max_angle, 0);
  EXPECT_EQ(result.euler_characteristic, 2);
}

TEST(InspectionDefect, FacesWithFewerThanThreeCornersAreNamed) {
  PolygonMesh mesh = test::cube();
  mesh.corners.insert(mesh.corners.end(), {0, 1});
  mesh.face_start.push_back(static_cast<int>(mesh.corners.size()));
  expect_only(inspect(mesh), DefectKind::too_few_corners, 1,
              "face 6 has 2 corners; remove it, since a face needs three");
  mesh.face_start.push_back(static_cast<int>(mesh.corners.size()));
  expect_only(inspect(mesh), DefectKind::too_few_corners, 2,
              "face 6 has 2 corners (2 such faces); remove it, since a face needs three");
}

TEST(InspectionDefect, RepeatedVerticesAreNamedEvenWhenTheyAreNoNeighbors) {
  expect_only(inspect(test::with_face(test::octahedron(), 0, 2, 0)), DefectKind::repeated_vertex, 1,
              "face 8 names vertex 0 more than once; correct the face or remove it");
  PolygonMesh mesh = test::cube();
  mesh.corners.insert(mesh.corners.end(), {0, 1, 2, 1});
  mesh.face_start.push_back(static_cast<int>(mesh.corners.size()));
  expect_only(inspect(mesh), DefectKind::repeated_vertex, 1,
              "face 6 names vertex 1 more than once; correct the face or remove it");
}

TEST(InspectionDefect, DuplicateFacesAreFoundInAnyRotationAndDirectionAndBringNoFurtherClaims) {
  const Inspection same = inspect(test::with_face(test::octahedron(), 2, 4, 0));
  expect_only(same, DefectKind::duplicate_face, 1,
              "faces 0 and 8 have the same vertices; remove one of them");
  EXPECT_EQ(same.euler_characteristic, 2);
  const Inspection turned = inspect(test::with_face(test::octahedron(), 2, 0, 4));
  expect_only(turned, DefectKind::duplicate_face, 1,
              "faces 0 and 8 have the same vertices; remove one of them");
  EXPECT_TRUE(turned.orientable);
}

TEST(InspectionDefect, ADiskWithTwoSidesIsNothingButDuplicates) {
  Mesh mesh = test::grid_disk(3, 3);
  Triangles back = mesh.F.rowwise().reverse();
  mesh.F.conservativeResize(36, 3);
  mesh.F.bottomRows(18) = back;
  expect_only(inspect(mesh), DefectKind::duplicate_face, 18,
              "faces 0 and 18 have the same vertices (18 such faces); remove one of them");
}

TEST(InspectionDefect, EdgesOfThreeFacesNameTheFacesAndClaimNoGenus) {
  const Inspection result = inspect(test::with_face(test::icosphere(1), 0, 11, 12));
  EXPECT_THAT(kinds(result), ElementsAre(DefectKind::non_manifold_edge));
  const Mesh wall = test::with_face(test::octahedron(), 0, 2, 3);
  expect_only(inspect(wall), DefectKind::non_manifold_edge, 2,
              "edge (0, 2) belongs to 3 faces (0, 4 and 8) (2 such edges); remove the extra faces so that "
              "every edge has one "
              "or two");
  EXPECT_EQ(inspect(wall).genus, 0);
  EXPECT_TRUE(inspect(wall).orientable);
  EXPECT_THAT(inspect(wall).boundary, IsEmpty());
}

TEST(InspectionDefect, LongListsAreCutShort) {
  std::vector<Vector3> points = {{0, 0, 0}, {0, 0, 1}};
  std::vector<std::vector<int>> pages;
  for (int i = 0; i < 9; ++i) {
    points.emplace_back(std::cos(i), std::sin(i), 0);
    pages.push_back({0, 1, i + 2});
  }
  EXPECT_THAT(only_defect(inspect(test::mesh(points, pages))).message,
              HasSubstr("edge (0, 1) belongs to 9 faces (0, 1, 2, 3, 4 and 4 more)"));
}

TEST(InspectionDefect, APinchedVertexIsOneDefectAndOneComponent) {
  Mesh mesh = test::united(test::octahedron(), test::octahedron());
  mesh = test::with_vertices_merged(mesh, 4, 11);
  const Inspection result = inspect(mesh);
  expect_only(result, DefectKind::non_manifold_vertex, 1,
              "the faces around vertex 4 form 2 fans that meet only there (one of each: faces 0 and 12); "
              "give every fan its own "
              "copy of the vertex");
  EXPECT_EQ(result.components, 1);
}

TEST(InspectionDefect, APinchedBoundaryVertexIsOneDefect) {
  Mesh mesh = test::with_vertices_merged(test::grid_disk(4, 4), 0, 24);
  EXPECT_THAT(kinds(inspect(mesh)), ElementsAre(DefectKind::non_manifold_vertex));
}

TEST(InspectionDefect, ATurnedFaceNamesTheEdgeAndBothFaces) {
  expect_only(
      inspect(test::with_face_turned(test::octahedron(), 3)), DefectKind::inconsistent_orientation, 3,
      "faces 3 and 7 run through edge (0, 3) in the same direction (3 such edges); turn faces until all are "
      "counterclockwise seen from outside");
}

TEST(InspectionDefect, ADiskWithATurnedFaceStillHasItsBoundary) {
  const Inspection result = inspect(test::with_face_turned(test::grid_disk(3, 3), 0));
  EXPECT_THAT(kinds(result), ElementsAre(DefectKind::inconsistent_orientation));
  ASSERT_EQ(result.boundary.size(), 1u);
  EXPECT_EQ(result.boundary[0].size(), 12u);
}

TEST(InspectionDefect, ComponentsAreCountedWithTheirSizesAndAVertexOfTheSecond) {
  const Mesh mesh = test::united(test::octahedron(), test::icosphere(1));
  const Inspection result = inspect(mesh);
  expect_only(result, DefectKind::several_components, 2,
              "the surface has 2 components, of 80 and 8 faces, the first around vertex 6, the second around "
              "vertex 0; keep one "
              "of them or join them");
  EXPECT_EQ(result.euler_characteristic, 4);
  EXPECT_EQ(result.components, 2);
}

TEST(InspectionDefect, FacesThatWereNeverWeldedAreToldSo) {
  const Mesh solid = test::octahedron();
  Mesh soup;
  soup.V.resize(24, 3);
  soup.F.resize(8, 3);
  for (int c = 0; c < 24; ++c) {
    soup.V.row(c) = solid.V.row(solid.F.data()[c]);
    soup.F.data()[c] = c;
  }
  expect_only(inspect(soup), DefectKind::several_components, 8,
              "the surface has 8 components, of 1, 1, 1, 1, 1 and 3 more faces, the first around vertex 0, "
              "the second around "
              "vertex 3; keep one of them or join them (vertices 0 and 10 are at the same point: weld such "
              "vertices first)");
}

TEST(InspectionDefect, HolesAreCountedWithTheirLengthsAndAVertexOfEach) {
  expect_only(inspect(test::annulus(12)), DefectKind::holes, 2,
              "the surface has 2 holes, of 12 and 12 edges, through vertices 0 and 1; fill all of them for a "
              "sphere, or all but "
              "one for a disk");
  const Inspection grid = inspect(test::without_faces(test::grid_disk(9, 9), {60, 100}));
  EXPECT_THAT(message(grid, DefectKind::holes), HasSubstr("the surface has 3 holes, of 36, 3 and 3 edges"));
  EXPECT_EQ(grid.genus, 0);
  EXPECT_EQ(grid.boundary.size(), 3u);
}

TEST(InspectionDefect, HolesOfOneOfSeveralComponentsAreItsOwn) {
  const Inspection result = inspect(test::united(test::round_disk(2), test::annulus(8)));
  EXPECT_THAT(kinds(result), ElementsAre(DefectKind::several_components, DefectKind::holes));
  EXPECT_THAT(
      message(result, DefectKind::holes),
      HasSubstr("the component of vertex 19 has 2 holes, of 8 and 8 edges, through vertices 19 and 20"));
  EXPECT_THAT(kinds(inspect(test::united(test::round_disk(2), test::round_disk(3)))),
              ElementsAre(DefectKind::several_components));
}

TEST(InspectionDefect, ATorusHasGenusOne) {
  const Inspection result = inspect(test::torus(8, 5));
  expect_only(result, DefectKind::genus, 1,
              "the surface has genus 1 (a handle, as a torus has); an orbifold embedding needs a sphere or a "
              "disk: cut the handle "
              "and close the two ends");
  EXPECT_EQ(result.genus, 1);
  EXPECT_EQ(result.euler_characteristic, 0);
}

TEST(InspectionDefect, ATorusWithHolesHasBoth) {
  const Inspection result = inspect(test::without_faces(test::torus(9, 9), {0, 80}));
  EXPECT_THAT(kinds(result), ElementsAre(DefectKind::holes, DefectKind::genus));
  EXPECT_EQ(result.genus, 1);
}

TEST(InspectionDefect, MoebiusStripsAndKleinBottlesAreNotOrientable) {
  const Inspection strip = inspect(test::moebius_strip(5));
  EXPECT_THAT(only_defect(strip).message,
              AllOf(HasSubstr("the surface is not orientable (Euler characteristic 0, 1 hole): faces 0 and "),
                    HasSubstr("no turning of faces")));
  EXPECT_EQ(only_defect(strip).kind, DefectKind::not_orientable);
  EXPECT_FALSE(strip.orientable);
  ASSERT_EQ(strip.boundary.size(), 1u);
  EXPECT_EQ(strip.boundary[0].size(), 10u);

  const Inspection bottle = inspect(test::klein_bottle(6, 5));
  EXPECT_THAT(only_defect(bottle).message, HasSubstr("not orientable (Euler characteristic 0, no holes)"));
  EXPECT_EQ(bottle.genus, 0);
}

TEST(InspectionDefect, ASurfaceInManyWaysWrongIsToldAllAtOnce) {
  Mesh mesh = test::united(test::with_face_turned(test::torus(8, 6), 3), test::octahedron());
  mesh = test::with_face(mesh, mesh.F(40, 1), mesh.F(40, 0), mesh.F(40, 2));
  mesh.V(7, 2) = std::numeric_limits<double>::infinity();
  EXPECT_THAT(kinds(inspect(mesh)), ElementsAre(DefectKind::non_finite_position, DefectKind::duplicate_face,
                                                DefectKind::inconsistent_orientation,
                                                DefectKind::several_components, DefectKind::genus));
}

TEST(InspectionDefect, RequireEmbeddableThrowsTheFirstSentence) {
  const Inspection result = inspect(test::torus(4, 4));
  try {
    require_embeddable(result);
    FAIL() << "a torus was accepted";
  } catch (const MeshError& error) {
    EXPECT_EQ(std::string(error.what()), result.defects.front().message);
  }
}

TEST(InspectionDefect, EveryKindHasItsName) {
  EXPECT_EQ(name_of(DefectKind::empty_mesh), "empty_mesh");
  EXPECT_EQ(name_of(DefectKind::non_manifold_edge), "non_manifold_edge");
  EXPECT_EQ(name_of(DefectKind::not_orientable), "not_orientable");
}

TEST(InspectionDefect, OffsetsThatDoNotFitTheCornersAreRefused) {
  PolygonMesh mesh = test::cube();
  mesh.face_start.back() += 1;
  EXPECT_THROW(inspect(mesh), ArgumentError);
  mesh.face_start = {};
  EXPECT_THROW(inspect(mesh), ArgumentError);
}

// ------------------------------------------------------------------------------------------------ quality

TEST(InspectionQuality, RegularTrianglesHaveOneAngleAndOneLength) {
  const Inspection result = inspect(test::octahedron());
  EXPECT_NEAR(result.min_angle, std::numbers::pi / 3, 1e-14);
  EXPECT_NEAR(result.max_angle, std::numbers::pi / 3, 1e-14);
  EXPECT_NEAR(result.min_edge_length, std::sqrt(2), 1e-14);
  EXPECT_NEAR(result.max_edge_length, std::sqrt(2), 1e-14);
  EXPECT_NEAR(result.area, 4 * std::sqrt(3), 1e-13);
  EXPECT_EQ(result.negative_cotangent_edges + result.zero_cotangent_edges, 0);
}

TEST(InspectionQuality, DiagonalsOfSquaresHaveZeroCotangents) {
  const Inspection result = inspect(test::grid_disk(4, 3));
  EXPECT_EQ(result.zero_cotangent_edges, 12);
  EXPECT_EQ(result.negative_cotangent_edges, 0);
  EXPECT_DOUBLE_EQ(result.area, 12);
}

TEST(InspectionQuality, AnglesThatAddUpToMoreThanPiMakeANegativeCotangent) {
  // Two triangles over the edge (0, 1), flat, with angles of more than 90 degrees opposite to it.
  const Mesh kite = test::mesh({{-1, 0, 0}, {1, 0, 0}, {0, 0.5, 0}, {0, -0.5, 0}}, {{0, 1, 2}, {1, 0, 3}});
  EXPECT_EQ(inspect(kite).negative_cotangent_edges, 1);
  EXPECT_NEAR(inspect(kite).max_angle, 2 * std::atan(2), 1e-14);
}

TEST(InspectionQuality, ZeroAreaFacesAreCountedAndNoDefect) {
  Mesh mesh = test::grid_disk(2, 2);
  mesh.V.row(4) = mesh.V.row(0);
  const Inspection result = inspect(mesh);
  EXPECT_THAT(kinds(result), IsEmpty());
  EXPECT_EQ(result.topology, Topology::disk);
  EXPECT_EQ(result.zero_area_faces, 2);
  EXPECT_GT(result.min_angle, 0);
  EXPECT_GT(result.min_edge_length, 0);
}

TEST(InspectionQuality, ATriangleWithItsCornersOnALineHasNoAreaWhateverTheRounding) {
  const Vector3 start(0.1, 0.7, -0.3), direction(0.3, 0.1, 0.7);
  const Mesh mesh = test::mesh({start, start + 0.1 * direction, start + 0.7 * direction}, {{0, 1, 2}});
  EXPECT_EQ(inspect(mesh).zero_area_faces, 1);
}

TEST(InspectionQuality, OfPolygonsIsThatOfTheirOwnEdgesAndCorners) {
  const Inspection cube = inspect(test::cube());
  PolygonMesh mixed = test::cube();
  mixed.face_start.insert(mixed.face_start.begin() + 1, 3);  // a face in two: first three corners
  mixed.corners.insert(mixed.corners.begin() + 3, {mixed.corners[2], mixed.corners[3], mixed.corners[0]});
  mixed.corners.erase(mixed.corners.begin() + 6);
  for (int& start : mixed.face_start)
    if (start > 3) start += 2;
  const Inspection halved = inspect(mixed);
  EXPECT_DOUBLE_EQ(halved.area, cube.area);
  EXPECT_DOUBLE_EQ(cube.min_angle, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(cube.max_angle, std::numbers::pi / 2);
  EXPECT_DOUBLE_EQ(cube.min_edge_length, cube.max_edge_length);
  EXPECT_DOUBLE_EQ(cube.area, 6 * cube.max_edge_length * cube.max_edge_length);
  EXPECT_DOUBLE_EQ(halved.min_angle, std::numbers::pi / 4);
}

TEST(InspectionQuality, APolygonThatBendsInwardsHasAnAngleAbovePi) {
  PolygonMesh arrow;
  arrow.V = (Points(4, 3) << 0, 0, 0, 2, -1, 0, 1, 0, 0, 2, 1, 0).finished();
  arrow.corners = {0, 1, 2, 3};
  arrow.face_start = {0, 4};
  EXPECT_NEAR(inspect(arrow).area, 1, 1e-15);
  EXPECT_NEAR(inspect(arrow).max_angle, 3 * std::numbers::pi / 2, 1e-14);
}

TEST(Inspection, AMeshWithoutAreaIsDefective) {
  Mesh mesh = test::octahedron();
  mesh.V.setConstant(3);
  expect_only(
      inspect(mesh), DefectKind::no_area, 8,
      "no face has any area, since all vertices are at the same point; give the vertices their positions");
  mesh.V.col(0).setLinSpaced(0.0, 1.0);
  expect_only(inspect(mesh), DefectKind::no_area, 8,
              "no face has any area; give the vertices their positions");
  mesh.V.row(1) << 0, 1, 0;
  EXPECT_THAT(kinds(inspect(mesh)), IsEmpty());
}

TEST(Inspection, CoordinatesWhoseSquaresAreNoDoublesAreADefect) {
  Mesh mesh = test::octahedron();
  for (const double scale : {1e-149, 1e149})
    EXPECT_THAT(kinds(inspect(Mesh{scale * mesh.V, mesh.F})), IsEmpty());
  const Inspection huge = inspect(Mesh{1e200 * mesh.V, mesh.F}),
                   tiny = inspect(Mesh{1e-200 * mesh.V, mesh.F});
  for (const Inspection& result : {huge, tiny}) {
    EXPECT_THAT(kinds(result), ElementsAre(DefectKind::size_out_of_range));
    EXPECT_EQ(result.topology, Topology::other);
  }
  EXPECT_THAT(message(huge, DefectKind::size_out_of_range), HasSubstr("scale the mesh down"));
  EXPECT_THAT(message(tiny, DefectKind::size_out_of_range), HasSubstr("scale it up"));
}

TEST(Inspection, VerticesDoubledAlongASeamAreToldAtTheSamePointOrNearly) {
  const Mesh disk = test::round_disk(4);
  EXPECT_EQ(inspect(disk).welding_advice, "");
  const std::vector<int> boundary = inspect(disk).boundary.front();
  const int v = boundary[0], w = boundary[5];
  const auto [first, second] = std::minmax(v, w);
  for (const double distance : {0.0, 1e-8}) {
    Mesh folded = disk;
    folded.V.row(w) = folded.V.row(v) + distance * Eigen::RowVector3d(1, 0, 0);
    EXPECT_THAT(inspect(folded).welding_advice,
                testing::StartsWith("vertices " + std::to_string(first) + " and " + std::to_string(second) +
                                    (distance > 0 ? " are only 1e-08 apart" : " are at the same point")));
  }
  Mesh short_edge = disk;  // neighbours on the boundary are no seam
  short_edge.V.row(boundary[1]) = short_edge.V.row(v) + 1e-8 * Eigen::RowVector3d(1, 0, 0);
  EXPECT_EQ(inspect(short_edge).welding_advice, "");
}

RC_GTEST_PROP(InspectionQuality, AnglesAndCotangentsDoNotDependOnTheScale, ()) {
  Mesh mesh = test::perturbed(test::icosphere(1), 0.2, *rc::gen::arbitrary<std::uint32_t>());
  const Inspection result = inspect(mesh);
  const int exponent = *rc::gen::inRange(-150, 150);
  mesh.V *= std::pow(10.0, exponent);
  const Inspection scaled = inspect(mesh);
  RC_ASSERT(std::abs(scaled.min_angle - result.min_angle) < 1e-12);
  RC_ASSERT(std::abs(scaled.max_angle - result.max_angle) < 1e-12);
  RC_ASSERT(scaled.negative_cotangent_edges == result.negative_cotangent_edges);
  RC_ASSERT(scaled.zero_area_faces == 0);
}

// ------------------------------------------------------------------------------------------------ properties

// One of the sound or unsound surfaces above.
Mesh any_mesh() {
  const int a = *rc::gen::inRange(4, 9), b = *rc::gen::inRange(4, 9);
  switch (*rc::gen::inRange(0, 9)) {
    case 0:
      return test::icosphere(*rc::gen::inRange(0, 3));
    case 1:
      return test::grid_disk(a, b);
    case 2:
      return test::torus(a, b);
    case 3:
      return test::annulus(a);
    case 4:
      return test::moebius_strip(a);
    case 5:
      return test::klein_bottle(a, b);
    case 6:
      return test::projective_plane(*rc::gen::inRange(0, 2));
    case 7:
      return test::united(test::octasphere(1), test::torus(a, b));
    default:
      return test::with_vertices_merged(test::grid_disk(a, b), 0, (a + 1) * (b + 1) - 1);
  }
}

void expect_same_counts(const Inspection& a, const Inspection& b) {
  RC_ASSERT(kinds(a) == kinds(b));
  for (std::size_t d = 0; d < a.defects.size(); ++d) RC_ASSERT(a.defects[d].count == b.defects[d].count);
  RC_ASSERT(a.edges == b.edges);
  RC_ASSERT(a.components == b.components);
  RC_ASSERT(a.euler_characteristic == b.euler_characteristic);
  RC_ASSERT(a.genus == b.genus);
  RC_ASSERT(a.orientable == b.orientable);
  RC_ASSERT(a.topology == b.topology);
  RC_ASSERT(a.boundary.size() == b.boundary.size());
  for (std::size_t c = 0; c < a.boundary.size(); ++c) RC_ASSERT(a.boundary[c].size() == b.boundary[c].size());
  RC_ASSERT(a.zero_area_faces == b.zero_area_faces);
  RC_ASSERT(a.negative_cotangent_edges == b.negative_cotangent_edges);
  RC_ASSERT(a.zero_cotangent_edges == b.zero_cotangent_edges);
}

RC_GTEST_PROP(InspectionProperty, NumberingsAndOrdersChangeNoCount, ()) {
  const Mesh mesh = any_mesh();
  const auto seed = *rc::gen::arbitrary<std::uint32_t>();
  const Mesh other =
      test::reordered(test::relabelled(mesh, test::permutation(test::vertex_count(mesh), seed)),
                      test::permutation(test::face_count(mesh), seed + 1));
  expect_same_counts(inspect(mesh), inspect(other));
}

RC_GTEST_PROP(InspectionProperty, ToriWithHolesHaveTheirEulerCharacteristicAndGenus, ()) {
  const int around = *rc::gen::inRange(5, 12), across = *rc::gen::inRange(5, 12),
            holes = *rc::gen::inRange(0, 2);
  std::vector<int> removed;
  for (int i = 0; i < holes; ++i) removed.push_back(2 * across * (2 * i + 1));
  const Inspection result = inspect(test::without_faces(test::torus(around, across), removed));
  RC_ASSERT(result.euler_characteristic == -holes);
  RC_ASSERT(result.genus == 1);
  RC_ASSERT(static_cast<int>(result.boundary.size()) == holes);
}

RC_GTEST_PROP(InspectionProperty, SpheresJoinedByTubesHaveAHandleForEveryFurtherTube, ()) {
  // Two spheres, some faces of the one joined to the same faces of the other by three squares.
  const Mesh outer = test::icosphere(2);
  Mesh inner = outer;
  inner.V *= 0.5;
  inner.F = inner.F.rowwise().reverse().eval();
  const std::vector<int> faces = {0, 40, 80, 120, 160, 200};
  const int tubes = *rc::gen::inRange(1, 7);
  const std::vector<int> removed(faces.begin(), faces.begin() + tubes);
  Mesh mesh = test::united(test::without_faces(outer, removed), test::without_faces(inner, removed));
  for (const int f : removed) {
    for (int k = 0; k < 3; ++k) {
      const int a = outer.F(f, k), b = outer.F(f, (k + 1) % 3), n = test::vertex_count(outer);
      mesh = test::with_face(test::with_face(mesh, a, b, b + n), a, b + n, a + n);
    }
  }
  const Inspection result = inspect(mesh);
  RC_ASSERT(result.genus == tubes - 1);
  RC_ASSERT(kinds(result) == (tubes == 1 ? std::vector<DefectKind>() : std::vector{DefectKind::genus}));
}

RC_GTEST_PROP(InspectionProperty, BoundaryCurvesAreLoopsOfHalfEdges, ()) {
  const Mesh disk = test::round_disk(*rc::gen::inRange(1, 6));
  const Inspection result = inspect(test::relabelled(
      disk, test::permutation(test::vertex_count(disk), *rc::gen::arbitrary<std::uint32_t>())));
  RC_ASSERT(result.boundary.size() == 1u);
  const auto& curve = result.boundary[0];
  RC_ASSERT(curve.front() == *std::min_element(curve.begin(), curve.end()));
}

RC_GTEST_PROP(InspectionProperty, APlantedDefectIsAlwaysFound, ()) {
  Mesh mesh = test::icosphere(2);
  const int f = *rc::gen::inRange(0, 320), k = *rc::gen::inRange(0, 3), n = test::vertex_count(mesh);
  const int far = 11 - mesh.F(f, 0) % 12;  // on the icosahedron, no neighbour of any vertex of another corner
  DefectKind planted;
  switch (*rc::gen::inRange(0, 7)) {
    case 0:
      mesh.F(f, k) =
          *rc::gen::element(-1, n, std::numeric_limits<int>::min(), std::numeric_limits<int>::max());
      planted = DefectKind::index_out_of_range;
      break;
    case 1:
      mesh.V(mesh.F(f, k), 1) = -std::numeric_limits<double>::infinity();
      planted = DefectKind::non_finite_position;
      break;
    case 2:
      mesh.F(f, k) = mesh.F(f, (k + 1) % 3);
      planted = DefectKind::repeated_vertex;
      break;
    case 3:
      mesh = test::with_face(mesh, mesh.F(f, k), mesh.F(f, (k + 2) % 3), mesh.F(f, (k + 1) % 3));
      planted = DefectKind::duplicate_face;
      break;
    case 4:
      mesh = test::with_face_turned(mesh, f);
      planted = DefectKind::inconsistent_orientation;
      break;
    case 5:
      mesh = test::with_vertices_merged(mesh, far, 11 - far);
      planted = DefectKind::non_manifold_vertex;
      break;
    default:
      mesh = test::united(mesh, test::octahedron());
      planted = DefectKind::several_components;
  }
  RC_ASSERT(kinds(inspect(mesh)) == std::vector{planted});
}

RC_GTEST_PROP(InspectionProperty, NoIndicesWhateverLeadAstray, ()) {
  const int vertices = *rc::gen::inRange(0, 9);
  const auto polygons = *rc::gen::container<std::vector<std::vector<int>>>(
      rc::gen::container<std::vector<int>>(rc::gen::inRange(-1, vertices + 2)));
  const PolygonMesh mesh = test::polygon_mesh(std::vector<Vector3>(vertices, Vector3::Ones()), polygons);
  const Inspection result = inspect(mesh);
  RC_ASSERT((result.topology == Topology::other) == !result.defects.empty());
  RC_ASSERT(std::is_sorted(result.defects.begin(), result.defects.end(),
                           [](const Defect& a, const Defect& b) { return a.kind < b.kind; }));
}

// ------------------------------------------------------------------------------------------------ real
// meshes

struct RealMesh {
  const char* file;
  Topology topology;
  int vertices, faces;
};

void PrintTo(const RealMesh& mesh, std::ostream* out) { *out << mesh.file; }

class InspectionOfRealMeshes : public testing::TestWithParam<RealMesh> {};

TEST_P(InspectionOfRealMeshes, KnowsTheirTopology) {
  const std::string path = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/" + GetParam().file;
  if (!std::filesystem::exists(path)) GTEST_SKIP() << "no real meshes here: " << path << " is missing";
  const Inspection result = inspect(read_mesh(path));
  EXPECT_THAT(kinds(result), IsEmpty());
  EXPECT_EQ(result.topology, GetParam().topology);
  EXPECT_EQ(result.vertices, GetParam().vertices);
  EXPECT_EQ(result.faces, GetParam().faces);
}

INSTANTIATE_TEST_SUITE_P(, InspectionOfRealMeshes,
                         testing::Values(RealMesh{"armadillo.obj", Topology::sphere, 43243, 86482},
                                         RealMesh{"bunny.off", Topology::sphere, 34835, 69666},
                                         RealMesh{"camelhead.off", Topology::disk, 11381, 22704},
                                         RealMesh{"cortex_icbm152_lh.off", Topology::sphere, 40962, 81920},
                                         RealMesh{"david_50k.off", Topology::sphere, 25002, 50000},
                                         RealMesh{"face.obj", Topology::disk, 17157, 34144},
                                         RealMesh{"fandisk.off", Topology::disk, 20425, 40500},
                                         RealMesh{"hippocampus.off", Topology::disk, 32004, 63250},
                                         RealMesh{"igea.ply", Topology::sphere, 134345, 268686},
                                         RealMesh{"itokawa.off", Topology::sphere, 6098, 12192},
                                         RealMesh{"my_man_maxp.off", Topology::sphere, 2502, 5000},
                                         RealMesh{"octocat.off", Topology::sphere, 4279, 8554},
                                         RealMesh{"spot.obj", Topology::sphere, 11533, 23062},
                                         RealMesh{"thingi_62415.obj", Topology::sphere, 787, 1570}),
                         [](const auto& each) {
                           const std::string file = each.param.file;
                           return file.substr(0, file.find('.'));
                         });

}  // namespace
}  // namespace orbitutte::inspection_test
