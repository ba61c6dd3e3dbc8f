// SPDX-License-Identifier: MIT
// Disks onto convex spherical polygons: theorem 1.
#include "orbitutte/orbifold/polygon.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <functional>
#include <numbers>
#include <random>
#include <set>

#include "hand_made.h"
#include "orbitutte/embed.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/io/corner_file.h"
#include "orbitutte/io/file.h"
#include "sample_embeddings.h"

namespace orbitutte::polygon_test {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Corners = std::vector<PolygonCorner>;
using Names = std::set<std::string>;

constexpr int rings = 6, on_boundary = 6 * rings, first_on_boundary = 3 * rings * (rings - 1) + 1;

Mesh bent_disk() {
  Mesh mesh = test::round_disk(rings);
  mesh.V.col(2) = 0.4 * mesh.V.col(0).array().square() - 0.2 * mesh.V.col(1).array();
  return test::perturbed(mesh, 0.015, 7);
}

// The k-th vertex of the disk's boundary, counterclockwise.
int boundary_vertex(int k) { return first_on_boundary + k % on_boundary; }

Vector3 around_pole(double colatitude, double longitude) {
  return {std::sin(colatitude) * std::cos(longitude), std::sin(colatitude) * std::sin(longitude),
          std::cos(colatitude)};
}

// A regular polygon of so many corners, at vertices that are as far from each other as the boundary allows.
Corners regular_polygon(int corners, double colatitude) {
  Corners result;
  for (int k = 0; k < corners; ++k)
    result.push_back(
        {boundary_vertex(k * on_boundary / corners), around_pole(colatitude, 2 * pi * k / corners)});
  return result;
}

// Corners on a circle, stretched by a linear map, which takes great arcs to great arcs, and turned; at any
// vertices of the boundary.
Corners random_polygon(std::mt19937& random) {
  const auto uniform = [&](double a, double b) {
    return std::uniform_real_distribution<double>(a, b)(random);
  };
  const int count = 3 + static_cast<int>(random() % 10);
  std::vector<int> places(on_boundary);
  for (int k = 0; k < on_boundary; ++k) places[k] = k;
  std::shuffle(places.begin(), places.end(), random);
  std::sort(places.begin(), places.begin() + count);
  const double colatitude = uniform(0.1, 1.4), stretch = uniform(0.3, 1);
  const Matrix3 turn = Eigen::Quaterniond(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1), uniform(-1, 1))
                           .normalized()
                           .toRotationMatrix();
  Corners result;
  for (int k = 0; k < count; ++k) {
    Vector3 p = around_pole(colatitude, 2 * pi * (k + uniform(0, 0.6)) / count);
    p[0] *= stretch;
    result.push_back({boundary_vertex(places[k]), (turn * p.normalized()).normalized()});
  }
  return result;
}

EmbedResult embedded(const Mesh& mesh, const Corners& corners, Spread spread = Spread::arc_length) {
  EmbedOptions options;
  options.threads = 1;
  options.spread = spread;
  const Target polygon = polygon_target(corners);
  return embed(mesh, polygon, corner_vertices(polygon), options);
}

Names failed_checks(const Certificate& certificate) {
  Names names;
  for (const Check& check : certificate.checks)
    if (!check.passed) names.insert(check.name + ": " + check.detail);
  return names;
}

void expect_certified(const EmbedResult& result) {
  EXPECT_EQ(result.minimum.termination, Termination::converged);
  EXPECT_THAT(failed_checks(result.certificate), IsEmpty());
  EXPECT_TRUE(result.certificate.bijective);
}

// The sentence with which the polygon, or the mesh with it, is refused.
std::string refusal_of_corners(const Corners& corners) {
  try {
    embedded(bent_disk(), corners);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "accepted";
}

auto names(int vertex) { return HasSubstr("vertex " + std::to_string(vertex)); }

// Embedding

TEST(Polygon, AnyConvexPolygonIsCertified) {
  std::mt19937 random(3);
  for (int k = 0; k < 40; ++k) {
    const Corners corners = random_polygon(random);
    for (const Spread spread : {Spread::arc_length, Spread::equidistant})
      expect_certified(embedded(bent_disk(), corners, spread));
  }
}

TEST(Polygon, CornersStayWhereTheyAreHeld) {
  std::mt19937 random(5);
  const Corners corners = random_polygon(random);
  const EmbedResult result = embedded(bent_disk(), corners);
  for (const PolygonCorner& corner : corners)
    EXPECT_LT((result.embedding.positions.row(corner.vertex).transpose() - corner.position).norm(), 1e-15);
  EXPECT_EQ(result.embedding.target.signature, "polygon");
  EXPECT_EQ(result.embedding.target.group_order, 1);
  EXPECT_THAT(result.embedding.seams, IsEmpty());
  ASSERT_EQ(result.embedding.cones.size(), corners.size());
  EXPECT_EQ(result.embedding.cones.front().mark.kind, ConeKind::fixed);
}

TEST(Polygon, BoundaryVerticesAreSpreadAsAsked) {
  const Mesh mesh = bent_disk();
  const Corners corners = regular_polygon(4, 0.9);
  const int steps = on_boundary / 4;
  const double side = Space::sphere().distance(corners[0].position, corners[1].position);
  double path = 0;
  for (int k = 0; k < steps; ++k)
    path += (mesh.V.row(boundary_vertex(k + 1)) - mesh.V.row(boundary_vertex(k))).norm();
  const Points equal = embedded(mesh, corners, Spread::equidistant).embedding.positions;
  const Points by_length = embedded(mesh, corners, Spread::arc_length).embedding.positions;
  for (int k = 0; k < steps; ++k) {
    const int v = boundary_vertex(k), w = boundary_vertex(k + 1);
    EXPECT_NEAR(Space::sphere().distance(equal.row(v), equal.row(w)), side / steps, 1e-12);
    EXPECT_NEAR(Space::sphere().distance(by_length.row(v), by_length.row(w)) / side,
                0.999 * (mesh.V.row(w) - mesh.V.row(v)).norm() / path + 0.001 / steps, 1e-12);
  }
}

TEST(Polygon, RotatingItRotatesTheMap) {
  std::mt19937 random(9);
  const Matrix3 turn = hand_made::rotation({1, -2, 0.5}, 1.1);
  for (int k = 0; k < 5; ++k) {
    Corners corners = random_polygon(random);
    const EmbedResult here = embedded(bent_disk(), corners);
    for (PolygonCorner& corner : corners) corner.position = (turn * corner.position).normalized();
    const EmbedResult there = embedded(bent_disk(), corners);
    EXPECT_LT((here.embedding.positions * turn.transpose() - there.embedding.positions).cwiseAbs().maxCoeff(),
              1e-8);
    EXPECT_NEAR(here.minimum.energy, there.minimum.energy, 1e-10);
    EXPECT_NEAR(here.certificate.expected_area, there.certificate.expected_area, 1e-12);
  }
}

TEST(Polygon, TheFirstCornerIsAnyOfThem) {
  std::mt19937 random(10);
  Corners corners = random_polygon(random);
  const EmbedResult here = embedded(bent_disk(), corners);
  std::rotate(corners.begin(), corners.begin() + 2, corners.end());
  const EmbedResult there = embedded(bent_disk(), corners);
  expect_certified(there);
  EXPECT_LT((here.embedding.positions - there.embedding.positions).cwiseAbs().maxCoeff(), 1e-8);
}

TEST(Polygon, StraightCornersAreAllowed) {
  Corners corners = regular_polygon(3, 0.8);
  const Vector3 middle = (corners[0].position + corners[1].position).normalized();
  corners.insert(corners.begin() + 1, {boundary_vertex(3), middle});
  expect_certified(embedded(bent_disk(), corners));
}

TEST(Polygon, StraightCornersMayBeAsCloseAsCan) {
  Corners corners = regular_polygon(3, 0.8);
  const Vector3 here = corners[0].position, next = corners[1].position;
  for (int k = 5; k > 0; --k)
    corners.insert(corners.begin() + 1, {boundary_vertex(k), (here + 1e-7 * k * (next - here)).normalized()});
  EXPECT_EQ(polygon_target(corners).marks.size(), 8u);
}

TEST(Polygon, ASolverForManyEmbeddingsGivesTheSame) {
  EmbedOptions options;
  options.threads = 1;
  EmbeddingSolver solver(bent_disk(), options);
  for (const int corners : {3, 4, 3}) {
    const Target polygon = polygon_target(regular_polygon(corners, 0.9));
    const EmbedResult result = solver.embed(polygon, corner_vertices(polygon));
    EXPECT_EQ(result.embedding.positions, embedded(bent_disk(), polygon.corners).embedding.positions);
    expect_certified(
        solver.embed(parse_orbifold("*222"), {boundary_vertex(0), boundary_vertex(9), boundary_vertex(20)}));
  }
}

TEST(Polygon, EveryBoundaryVertexMayBeACorner) {
  expect_certified(embedded(bent_disk(), regular_polygon(on_boundary, 1.2)));
}

TEST(Polygon, MeshesWithoutVerticesInsideAreEmbedded) {
  const Mesh triangle = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  expect_certified(embedded(triangle, {{0, {1, 0, 0}}, {1, {0, 1, 0}}, {2, {0, 0, 1}}}));
  const Mesh square = test::grid_disk(1, 1);
  expect_certified(embedded(
      square,
      {{0, around_pole(1, 0)}, {1, around_pole(1, 1.5)}, {3, around_pole(1, 3)}, {2, around_pole(1, 4.5)}}));
}

// Two corners of a grid have a single triangle, all of whose vertices a side keeps on its great circle.
TEST(Polygon, TrianglesWithTwoEdgesOnASideAreRoundedOutward) {
  const int columns = 9, rows = 7, east = columns, north = rows * (columns + 1);
  std::mt19937 random(21);
  for (int k = 0; k < 10; ++k) {
    const double start = std::uniform_real_distribution<double>(0, 2 * pi)(random);
    const Corners corners = {{3, around_pole(1, start)},
                             {east - 2, around_pole(1, start + 1)},
                             {north + columns - 3, around_pole(1, start + 3)},
                             {north + 2, around_pole(1, start + 4.5)}};
    const EmbedResult result = embedded(test::grid_disk(columns, rows), corners);
    expect_certified(result);
    EXPECT_THAT(result.warnings, Contains(HasSubstr("on one mirror or held side")));
  }
}

TEST(Polygon, ItsAreaIsThatOfTheTriangleOfOneOctant) {
  EXPECT_NEAR(target_area(polygon_target({{0, {1, 0, 0}}, {1, {0, 1, 0}}, {2, {0, 0, 1}}})), pi / 2, 1e-15);
  EXPECT_NEAR(target_area(parse_orbifold("532")), 4 * pi / 60, 1e-15);
}

TEST(Polygon, ItHasNoTiling) {
  EXPECT_THROW(weld_copies(embedded(bent_disk(), regular_polygon(4, 0.7)).embedding), ArgumentError);
}

// Refusals

TEST(Polygon, NonConvexPolygonsAreRefused) {
  Corners corners = regular_polygon(6, 1.0);
  corners[4].position = around_pole(0.3, 2 * pi * 4 / 6);
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("not convex"), names(corners[4].vertex)));
}

TEST(Polygon, ClockwisePolygonsAreRefused) {
  Corners corners = regular_polygon(5, 1.0);
  std::reverse(corners.begin(), corners.end());
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("clockwise"), names(corners[0].vertex)));
  std::rotate(corners.begin(), corners.begin() + 3, corners.end());
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("clockwise"), names(corners[0].vertex)));
}

TEST(Polygon, PolygonsLargerThanAHemisphereAreRefused) {
  for (const double colatitude : {pi / 2 + 0.2, pi / 2 + 1e-6, pi / 2}) {
    const Corners corners = regular_polygon(5, colatitude);
    EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("hemisphere"), HasSubstr("vertex")))
        << colatitude;
  }
  expect_certified(embedded(bent_disk(), regular_polygon(5, pi / 2 - 0.01)));
}

TEST(Polygon, StarsThatGoAroundTwiceAreRefused) {
  Corners corners = regular_polygon(5, 0.8);
  for (int k = 0; k < 5; ++k) corners[k].position = around_pole(0.8, 4 * pi * k / 5);
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("more than once"), HasSubstr("vertex")));
}

TEST(Polygon, RepeatedAndOppositeCornersAreRefused) {
  Corners corners = regular_polygon(4, 0.8);
  corners[2].vertex = corners[0].vertex;
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("two corners"), names(corners[0].vertex)));
  corners = regular_polygon(4, 0.8);
  corners[2].position = corners[1].position;
  EXPECT_THAT(refusal_of_corners(corners),
              AllOf(HasSubstr("same point"), HasSubstr(std::to_string(corners[2].vertex))));
  corners[2].position = -corners[1].position;
  EXPECT_THAT(refusal_of_corners(corners),
              AllOf(HasSubstr("opposite"), HasSubstr(std::to_string(corners[2].vertex))));
  EXPECT_THAT(refusal_of_corners({corners[0], corners[1]}), HasSubstr("2 corners"));
  EXPECT_THAT(refusal_of_corners({}), HasSubstr("0 corners"));
}

TEST(Polygon, CornersThatAreNotOnTheBoundaryAreRefused) {
  Corners corners = regular_polygon(4, 0.8);
  corners[1].vertex = 0;
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("inside"), names(0)));
  corners[1].vertex = 5000;
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("out of range"), names(5000)));
}

TEST(Polygon, CornersInAnotherOrderThanTheBoundaryAreRefused) {
  Corners corners = regular_polygon(5, 0.8);
  std::swap(corners[2].vertex, corners[3].vertex);
  EXPECT_THAT(refusal_of_corners(corners),
              AllOf(HasSubstr("boundary"), HasSubstr(std::to_string(corners[2].vertex))));
  corners = regular_polygon(5, 0.8);
  std::vector<int> vertices = corner_vertices(polygon_target(corners));
  for (int k = 0; k < 5; ++k) corners[k].vertex = vertices[4 - k];
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("boundary"), HasSubstr("vertex")));
}

TEST(Polygon, PositionsOffTheSphereAreRefused) {
  Corners corners = regular_polygon(5, 0.8);
  corners[3].position *= 1.001;
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("unit sphere"), names(corners[3].vertex)));
  corners[3].position[0] = NAN;
  EXPECT_THAT(refusal_of_corners(corners), AllOf(HasSubstr("unit sphere"), names(corners[3].vertex)));
}

TEST(Polygon, SpheresAreRefused) {
  EXPECT_THROW(embedded(test::icosphere(1), {{0, {1, 0, 0}}, {1, {0, 1, 0}}, {2, {0, 0, 1}}}), MeshError);
}

// The file

class CornerFile : public testing::Test {
 protected:
  Corners read(const std::string& text) const {
    write_file(path, text);
    return read_corners(path);
  }
  std::string refused(const std::string& text) const {
    try {
      read(text);
    } catch (const MeshError& error) {
      return error.what();
    }
    return "accepted";
  }
  void TearDown() override { std::filesystem::remove(path); }

  const std::string path =
      (std::filesystem::temp_directory_path() /
       ("orbitutte_corners_" + std::string(testing::UnitTest::GetInstance()->current_test_info()->name()) +
        ".txt"))
          .string();
};

TEST_F(CornerFile, GivesAVertexAndAUnitVectorALine) {
  const Corners corners = read("# a comment\n12 1 0 0\n\n7 0 0.6 0.8 # another\r\n+3 -0.5774 -0.5774 0.5774");
  ASSERT_EQ(corners.size(), 3u);
  EXPECT_EQ(corners[0].vertex, 12);
  EXPECT_EQ(corners[0].position, Vector3(1, 0, 0));
  EXPECT_EQ(corners[1].vertex, 7);
  EXPECT_EQ(corners[2].vertex, 3);
  EXPECT_NEAR(corners[2].position.norm(), 1, 1e-15);
}

TEST_F(CornerFile, FaultsAreNamedWithFileLineAndVertex) {
  EXPECT_THAT(refused("1 1 0 0\n2 0 2 0\n"), AllOf(HasSubstr(path), HasSubstr("line 2"), names(2)));
  EXPECT_THAT(refused("1 1 0 0\n2 0 0 0\n"), AllOf(HasSubstr("line 2"), names(2)));
  EXPECT_THAT(refused("1 1 0 0\n2 0 nan 0\n"), AllOf(HasSubstr("line 2"), names(2)));
  EXPECT_THAT(refused("1 1 0 0 0\n"), AllOf(HasSubstr("line 1"), names(1)));
  EXPECT_THAT(refused("1 1 0\n2 0 1 0\n"), HasSubstr("line 1"));
  EXPECT_THAT(refused("1.5 1 0 0\n"), HasSubstr("line 1"));
  EXPECT_THROW(read_corners(path + ".nowhere"), FileError);
}

// The certificate

class PolygonCertificate : public testing::Test {
 protected:
  // Plants a fault; the names of the checks that fail.
  Names rejection(const std::function<void(Embedding&)>& plant) const {
    Embedding embedding = result.embedding;
    plant(embedding);
    const Certificate certificate = certify(test::unjudged(mesh), embedding);
    EXPECT_FALSE(certificate.bijective);
    Names failed;
    for (const Check& check : certificate.checks) {
      EXPECT_EQ(check.passed, check.detail.empty()) << check.name;
      if (!check.passed) failed.insert(check.name);
    }
    return failed;
  }

  const Mesh mesh = bent_disk();
  const EmbedResult result = embedded(mesh, regular_polygon(4, 0.9));
};

TEST_F(PolygonCertificate, ExpectsTheAreaOfThePolygon) {
  const Points& X = result.embedding.positions;
  const auto corner = [&](int k) -> Vector3 { return X.row(result.embedding.cones[k].vertex); };
  const double two_triangles = Space::sphere().area(corner(0), corner(1), corner(2)) +
                               Space::sphere().area(corner(0), corner(2), corner(3));
  EXPECT_NEAR(result.certificate.expected_area, two_triangles, 1e-14);
  EXPECT_NEAR(result.certificate.signed_area, two_triangles, 1e-12);
}

TEST_F(PolygonCertificate, RejectsAVertexOffItsSide) {
  for (const double by : {1e-3, 1e-9, -1e-9}) {
    const auto move = [&](Embedding& e) {
      e.positions.row(boundary_vertex(4)) *= 1 + by;
      e.positions(boundary_vertex(4), 2) += by;
      e.positions.row(boundary_vertex(4)).normalize();
    };
    EXPECT_THAT(rejection(move), Contains("held_sides")) << by;
  }
}

TEST_F(PolygonCertificate, RejectsVerticesExchangedOnASide) {
  const auto exchange = [](Embedding& e) {
    const Vector3 p = e.positions.row(boundary_vertex(3));
    e.positions.row(boundary_vertex(3)) = e.positions.row(boundary_vertex(4)).eval();
    e.positions.row(boundary_vertex(4)) = p;
  };
  EXPECT_THAT(rejection(exchange), Contains("held_sides"));
}

TEST_F(PolygonCertificate, RejectsAFlippedTriangle) {
  const auto flip = [](Embedding& e) {
    const Vector3 q = e.positions.row(1), r = e.positions.row(2), p = e.positions.row(0);
    e.positions.row(0) = (hand_made::reflection(q.cross(r).normalized()) * p).normalized();
  };
  EXPECT_THAT(rejection(flip), Contains("positive_faces"));
}

TEST_F(PolygonCertificate, RejectsTheMirroredMap) {
  EXPECT_THAT(rejection([](Embedding& e) { e.positions.col(0) *= -1; }), Contains("cones"));
}

TEST_F(PolygonCertificate, RejectsAnotherPolygonThanTheImage) {
  const auto leave_out = [](Embedding& e) { e.cones.pop_back(); };
  EXPECT_THAT(rejection(leave_out), AllOf(Contains("held_sides"), Contains("signed_area")));
  const auto exchange = [](Embedding& e) { std::swap(e.cones[0], e.cones[1]); };
  EXPECT_THAT(rejection(exchange), Contains("cones"));
  const auto none = [](Embedding& e) { e.cones.clear(); };
  EXPECT_THAT(rejection(none), Contains("cones"));
  const auto another_vertex = [](Embedding& e) {
    e.cones[2].vertex = 0;
    e.cones[2].copies = {0};
  };
  EXPECT_THAT(rejection(another_vertex), Contains("held_sides"));
  const auto no_vertex = [](Embedding& e) { e.cones[2].copies = {-7}; };
  EXPECT_THAT(rejection(no_vertex), Contains("cones"));
}

TEST_F(PolygonCertificate, RejectsAnotherSignatureOrGroup) {
  EXPECT_THAT(rejection([](Embedding& e) { e.target.group_order = 2; }), Contains("group_order"));
  EXPECT_THAT(rejection([](Embedding& e) { e.target.signature = "*222"; }), Contains("cones"));
  const auto claim_polygon = [](Embedding& e) { e.target.signature = "polygon"; };
  Embedding triangle = test::sample_embedding("*222").embedding();
  claim_polygon(triangle);
  EXPECT_FALSE(certify(test::unjudged(test::sample_embedding("*222").mesh), triangle).bijective);
}

}  // namespace
}  // namespace orbitutte::polygon_test
