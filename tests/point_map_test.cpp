// SPDX-License-Identifier: MIT
#include "orbitutte/map/point_map.h"

#include <gmock/gmock.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "orbitutte/geometry/barycentric_coordinates.h"
#include "orbitutte/geometry/orientation.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "sample_embeddings.h"

namespace orbitutte::point_map_test {
namespace {

using test::sample_embedding;
using test::sample_signatures;
using testing::HasSubstr;

Points random_directions(int count, unsigned seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Points points(count, 3);
  for (double& x : points.reshaped()) x = normal(random);
  points.rowwise().normalize();
  return points;
}

// Coordinates in the inner part of a triangle.
Vector3 random_coordinates(std::mt19937& random) {
  std::uniform_real_distribution<double> uniform(0.05, 1);
  const Vector3 coordinates(uniform(random), uniform(random), uniform(random));
  return coordinates / coordinates.sum();
}

SurfacePoints random_surface_points(const Embedding& embedding, int copies, int count) {
  std::mt19937 random(5);
  std::uniform_int_distribution<int> face(0, static_cast<int>(embedding.triangles.rows()) - 1),
      copy(0, copies - 1);
  SurfacePoints points = {{}, Points(count, 3), {}};
  for (int k = 0; k < count; ++k) {
    points.triangle.push_back(face(random));
    points.copy.push_back(copy(random));
    points.barycentric.row(k) = random_coordinates(random).transpose();
  }
  return points;
}

// Every corner and the middle of every edge of some triangles, in every copy.
Points corners_and_edges(const Embedding& embedding, const std::vector<Isometry>& copies,
                         const std::vector<int>& triangles) {
  const Points positions = embedding.canonical_positions();
  std::vector<Vector3> points;
  for (const int f : triangles)
    for (int k = 0; k < 3; ++k) {
      const Vector3 a = positions.row(embedding.triangles(f, k)),
                    b = positions.row(embedding.triangles(f, (k + 1) % 3));
      for (const Isometry& copy : copies) {
        points.push_back(copy * a);
        points.push_back(copy * embedding.space().retract(a + b));
      }
    }
  Points rows(static_cast<Eigen::Index>(points.size()), 3);
  for (Eigen::Index k = 0; k < rows.rows(); ++k) rows.row(k) = points[k].transpose();
  return rows;
}

// Triangles with a corner on a seam, in which cones are too.
std::vector<int> triangles_at_seams(const Embedding& embedding) {
  std::set<int> seam_vertices;
  for (const Seam& seam : embedding.seams) {
    seam_vertices.insert(seam.left.begin(), seam.left.end());
    seam_vertices.insert(seam.right.begin(), seam.right.end());
  }
  std::vector<int> triangles;
  for (int f = 0; f < embedding.triangles.rows(); ++f)
    for (const int v : embedding.triangles.row(f))
      if (seam_vertices.count(v) && (triangles.empty() || triangles.back() != f)) triangles.push_back(f);
  return triangles;
}

double largest_round_trip(const Embedding& embedding, const PointLocator& locator, const Points& directions) {
  const SurfacePoints found = locator.locate(directions);
  EXPECT_EQ(std::count(found.triangle.begin(), found.triangle.end(), -1), 0);
  return (map_points(embedding, found) - directions).cwiseAbs().maxCoeff();
}

TEST(PointMap, EveryDirectionIsTheImageOfThePointThatIsLocatedInEveryFamily) {
  for (const std::string& signature : sample_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const PointLocator locator(embedding);
    EXPECT_LE(largest_round_trip(embedding, locator, random_directions(3000, 1)), 1e-14) << signature;
  }
}

TEST(PointMap, EveryCopyHoldsItsShareOfTheSphere) {
  for (const std::string& signature : sample_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const SurfacePoints found = PointLocator(embedding).locate(random_directions(6000, 2));
    std::vector<int> count(embedding.target.group_order, 0);
    for (const int element : found.copy) ++count[element];
    const double share = 6000.0 / embedding.target.group_order;
    for (const int points : count) EXPECT_NEAR(points, share, 6 * std::sqrt(share)) << signature;
  }
}

TEST(PointMap, LocatingUndoesTheMapInEveryCopy) {
  for (const std::string& signature : sample_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const PointLocator locator(embedding);
    const SurfacePoints points = random_surface_points(embedding, embedding.target.group_order, 300);
    const SurfacePoints found = locator.locate(map_points(embedding, points));
    EXPECT_EQ(found.triangle, points.triangle) << signature;
    EXPECT_EQ(found.copy, points.copy) << signature;
    EXPECT_LE((found.barycentric - points.barycentric).cwiseAbs().maxCoeff(), 1e-9) << signature;
  }
}

TEST(PointMap, CornersAndEdgesAlongSeamsAreLocatedInEveryFamily) {
  for (const std::string& signature : sample_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const PointLocator locator(embedding);
    std::vector<int> triangles = triangles_at_seams(embedding);
    triangles.resize(std::min<std::size_t>(triangles.size(), 24));
    const Points points = corners_and_edges(embedding, locator.elements(), triangles);
    EXPECT_LE(largest_round_trip(embedding, locator, points), 1e-12) << signature;
  }
}

// Points on a mirror lie beside all copies by a rounding error, anywhere along the edges.
TEST(PointMap, PointsAnywhereOnMirrorsAreLocated) {
  for (const std::string signature : {"*432", "3*2", "2*3", "3*"}) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const Points positions = embedding.canonical_positions();
    std::vector<Vector3> points;
    for (const Seam& seam : embedding.seams) {
      if (seam.kind() != SeamKind::reflection) continue;
      for (std::size_t k = 1; k < seam.left.size(); ++k)
        for (double t = 0.0625; t < 1; t += 0.0625)
          points.push_back(embedding.space().retract((1 - t) * positions.row(seam.left[k - 1]).transpose() +
                                                     t * positions.row(seam.left[k]).transpose()));
    }
    Points rows(static_cast<Eigen::Index>(points.size()), 3);
    for (Eigen::Index k = 0; k < rows.rows(); ++k) rows.row(k) = points[k].transpose();
    ASSERT_GT(rows.rows(), 100) << signature;
    EXPECT_LE(largest_round_trip(embedding, PointLocator(embedding), rows), 1e-12) << signature;
  }
}

TEST(PointMap, ConesAreLocatedAtOneOfTheirCopies) {
  for (const std::string& signature : sample_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const PointLocator locator(embedding);
    for (const ConeCopies& cone : embedding.cones) {
      const SurfacePoints found = locator.locate(embedding.positions.row(cone.copies.front()));
      int corner = -1;
      EXPECT_NEAR(found.barycentric.row(0).maxCoeff(&corner), 1, 1e-9) << signature;
      EXPECT_EQ(embedding.source_vertex[embedding.triangles(found.triangle[0], corner)], cone.vertex)
          << signature;
    }
  }
}

TEST(PointMap, VerticesGoToTheirPositions) {
  const Embedding& embedding = sample_embedding("2*3").embedding();
  SurfacePoints points = {{}, Points(embedding.triangles.size(), 3), {}};
  for (int c = 0; c < embedding.triangles.size(); ++c) {
    points.triangle.push_back(c / 3);
    points.barycentric.row(c) = Vector3::Unit(c % 3).transpose();
  }
  const Points images = map_points(embedding, points);
  for (int c = 0; c < embedding.triangles.size(); ++c)
    EXPECT_LE((images.row(c) - embedding.positions.row(embedding.triangles.data()[c])).norm(), 3e-16);
}

TEST(PointMap, TrianglesAgreeOnTheirEdges) {
  const Embedding& embedding = sample_embedding("5x").embedding();
  const Connectivity connectivity =
      connectivity_of(embedding.triangles, static_cast<int>(embedding.source_vertex.size()));
  int inner = 0;
  for (int h = 0; h < embedding.triangles.size(); ++h) {
    const int other = connectivity.opposite[h];
    if (other < h) continue;
    SurfacePoints points = {{h / 3, other / 3}, Points::Zero(2, 3), {}};
    points.barycentric(0, h % 3) = points.barycentric(1, (other + 1 - 3 * (other / 3)) % 3) = 0.3;
    points.barycentric(0, (h + 1 - 3 * (h / 3)) % 3) = points.barycentric(1, other % 3) = 0.7;
    const Points images = map_points(embedding, points);
    EXPECT_LE((images.row(0) - images.row(1)).norm(), 3e-16);
    ++inner;
  }
  EXPECT_GT(inner, 900);
}

// The half-edge of the cut mesh that joins the two vertices, either way.
int halfedge_between(const Triangles& F, int v, int w) {
  for (int h = 0; h < F.size(); ++h)
    if ((halfedge_origin(F, h) == v && halfedge_target(F, h) == w) ||
        (halfedge_origin(F, h) == w && halfedge_target(F, h) == v))
      return h;
  return -1;
}

// The image of the point that is 0.3 of the way from v to w.
Vector3 point_between(const Embedding& embedding, int v, int w) {
  const int h = halfedge_between(embedding.triangles, v, w);
  SurfacePoints point = {{h / 3}, Points::Zero(1, 3), {}};
  for (int k = 0; k < 3; ++k) {
    const int corner = embedding.triangles(h / 3, k);
    point.barycentric(0, k) = corner == v ? 0.7 : corner == w ? 0.3 : 0;
  }
  return map_points(embedding, point).row(0);
}

TEST(PointMap, TransformsOfSeamsTakeTheRightBankToTheLeftOneBetweenVerticesToo) {
  for (const char* signature : {"432", "2x", "3*2", "5*"}) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    for (const Seam& seam : embedding.seams)
      for (std::size_t i = 0; i + 1 < seam.left.size(); ++i) {
        const Vector3 left = point_between(embedding, seam.left[i], seam.left[i + 1]);
        const Vector3 right = point_between(embedding, seam.right[i], seam.right[i + 1]);
        EXPECT_LE((left - seam.transform * right).norm(), 1e-13) << signature;
      }
  }
}

TEST(PointMap, NothingIsFoundWhereOnlyATriangleThatIsTurnedOverLies) {
  Embedding embedding = sample_embedding("532").embedding();
  SurfacePoints inside = {{7, 8}, Points::Constant(2, 3, 1.0 / 3), {4, 4}};
  const Points images = map_points(embedding, inside);
  std::swap(embedding.triangles(7, 0), embedding.triangles(7, 1));
  const SurfacePoints found = PointLocator(embedding).locate(images);
  EXPECT_EQ(found.triangle, (std::vector<int>{-1, 8}));
  EXPECT_EQ(found.copy, (std::vector<int>{-1, 4}));
  EXPECT_TRUE(found.barycentric.row(0).array().isNaN().all());
  EXPECT_TRUE(map_points(embedding, found).row(0).array().isNaN().all());
}

TEST(PointMap, DirectionsNeedNoLengthButOneThatIsPositiveAndFinite) {
  const Embedding& embedding = sample_embedding("432").embedding();
  const PointLocator locator(embedding);
  Points directions(5, 3);
  directions << 3, 4, 5, 3e-200, 4e-200, 5e-200, 0, 0, 0, 1, NAN, 0, INFINITY, 0, 0;
  const SurfacePoints found = locator.locate(directions);
  EXPECT_GE(found.triangle[0], 0);
  EXPECT_EQ(found.triangle[1], found.triangle[0]);
  for (int k = 2; k < 5; ++k) EXPECT_EQ(found.triangle[k], -1);
  EXPECT_EQ(locator.locate(Points(0, 3)).count(), 0);
}

TEST(PointMap, OutsideOfAPolygonNothingIsFound) {
  const Mesh mesh = test::round_disk(6);
  const std::vector<int> corners = choose_cones(mesh, parse_orbifold("*222"));
  const Connectivity connectivity = connectivity_of(mesh.F, test::vertex_count(mesh));
  std::vector<PolygonCorner> polygon;  // counterclockwise, as their longitudes on the disk are
  for (const int v : corners) polygon.push_back({v, Vector3(mesh.V(v, 0), mesh.V(v, 1), 1).normalized()});
  std::sort(polygon.begin(), polygon.end(), [](const PolygonCorner& a, const PolygonCorner& b) {
    return std::atan2(a.position.y(), a.position.x()) < std::atan2(b.position.y(), b.position.x());
  });
  const Target orbifold = polygon_target(polygon);
  const EmbedResult result = embed(mesh, orbifold, corner_vertices(orbifold));
  ASSERT_TRUE(result.certificate.bijective);
  const PointLocator locator(result.embedding);
  EXPECT_EQ(locator.elements().size(), 1u);
  const Points directions = random_directions(4000, 3);
  const SurfacePoints found = locator.locate(directions);
  double inside = 0;
  for (int k = 0; k < found.count(); ++k) {
    bool is_inside = true;
    for (std::size_t c = 0; c < polygon.size(); ++c)
      is_inside =
          is_inside &&
          polygon[c].position.cross(polygon[(c + 1) % polygon.size()].position).dot(directions.row(k)) > 0;
    EXPECT_EQ(found.triangle[k] >= 0, is_inside) << directions.row(k);
    inside += is_inside;
  }
  EXPECT_NEAR(inside / found.count(), result.certificate.signed_area / (4 * std::numbers::pi), 0.03);
}

TEST(PointMap, LocatingUndoesTheMapInTheCopiesOfThePlane) {
  for (const std::string& signature : test::planar_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const PointLocator locator(embedding);
    const int copies = PointLocator::default_copies;
    EXPECT_EQ(static_cast<int>(locator.elements().size()), copies) << signature;
    const SurfacePoints points = random_surface_points(embedding, copies, 300);
    const Points images = map_points(embedding, points);
    const SurfacePoints found = locator.locate(images);
    EXPECT_EQ(found.triangle, points.triangle) << signature;
    EXPECT_EQ(found.copy, points.copy) << signature;
    EXPECT_LE((found.barycentric - points.barycentric).cwiseAbs().maxCoeff(), 1e-9) << signature;
    EXPECT_EQ(images.col(2), Eigen::VectorXd::Ones(images.rows())) << signature;
  }
}

TEST(PointMap, EveryPointOfThePlaneNearTheTileIsTheImageOfThePointThatIsLocated) {
  for (const std::string& signature : test::planar_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    Points points = random_directions(3000, 4);
    points.col(2).setOnes();
    EXPECT_LE(largest_round_trip(embedding, PointLocator(embedding), points), 1e-14) << signature;
    const Points scaled = 4 * points;
    EXPECT_LE((map_points(embedding, PointLocator(embedding).locate(scaled)) - points).cwiseAbs().maxCoeff(),
              1e-14);
  }
}

TEST(PointMap, CornersAndEdgesAlongSeamsAreLocatedInThePlane) {
  for (const std::string& signature : test::planar_signatures()) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const PointLocator locator(embedding);
    const std::vector<Isometry> near(locator.elements().begin(), locator.elements().begin() + 10);
    const Points points = corners_and_edges(embedding, near, triangles_at_seams(embedding));
    EXPECT_LE(largest_round_trip(embedding, locator, points), 1e-12) << signature;
  }
}

TEST(PointMap, BeyondTheCopiesThatAreSearchedNothingIsFound) {
  const Embedding& embedding = sample_embedding("442").embedding();
  Points points(2, 3);
  points << 1000, 0, 1, 0.2, 0.1, 1;
  const SurfacePoints found = PointLocator(embedding).locate(points);
  EXPECT_EQ(found.triangle[0], -1);
  EXPECT_GE(found.triangle[1], 0);
}

// The map was turned to where doubles resolve it: points are mapped and located in the canonical frame.
TEST(PointMap, PlacementMakesNoDifference) {
  for (const char* signature : {"532", "2*3", "442", "*333"}) {
    const Embedding& embedding = sample_embedding(signature).embedding();
    const Isometry placement = embedding.space().rotation(embedding.space().retract({0.3, 0.2, 1}), 1.3);
    Embedding placed = embedding;
    placed.placement = placement;
    placed.positions = placement.on_rows(embedding.positions);
    for (Seam& seam : placed.seams) seam.transform = placement * seam.transform * placement.inverse();
    const SurfacePoints points = random_surface_points(embedding, 10, 300);
    const Points images = map_points(embedding, points);
    EXPECT_LE((map_points(placed, points) - images).cwiseAbs().maxCoeff(), 1e-13) << signature;
    const SurfacePoints found = PointLocator(placed).locate(images);
    EXPECT_EQ(found.triangle, points.triangle) << signature;
    EXPECT_EQ(found.copy, points.copy) << signature;
  }
}

std::string refusal_of_points(const Embedding& embedding, const SurfacePoints& points) {
  try {
    map_points(embedding, points);
  } catch (const ArgumentError& error) {
    return error.what();
  }
  return "accepted";
}

TEST(PointMap, PointsThatAreNoneAreNamed) {
  const Embedding& embedding = sample_embedding("432").embedding();
  const Points middle = Points::Constant(1, 3, 1.0 / 3);
  EXPECT_EQ(refusal_of_points(embedding, {{0}, middle, {23}}), "accepted");
  EXPECT_EQ(refusal_of_points(embedding, {{-1}, Points::Constant(1, 3, NAN), {-1}}), "accepted");
  EXPECT_THAT(refusal_of_points(embedding, {{320}, middle, {}}),
              HasSubstr("point 0 names the triangle 320; there are 320"));
  EXPECT_THAT(refusal_of_points(embedding, {{-2}, middle, {}}), HasSubstr("triangle -2"));
  EXPECT_THAT(refusal_of_points(embedding, {{0}, middle, {24}}), HasSubstr("the copy 24; there are 24"));
  EXPECT_THAT(refusal_of_points(embedding, {{0}, 2 * middle, {}}), HasSubstr("add up to 1"));
  EXPECT_THAT(refusal_of_points(embedding, {{0}, Vector3(1.5, -0.5, 0).transpose(), {}}),
              HasSubstr("not negative"));
  EXPECT_THAT(refusal_of_points(embedding, {{0, 1}, middle, {}}), HasSubstr("2 triangles, 1 rows"));
  Embedding broken = embedding;
  broken.triangles(5, 1) = 100000;
  EXPECT_THAT(refusal_of_points(broken, {{0}, middle, {}}), HasSubstr("does not exist"));
  EXPECT_THROW(PointLocator{broken}, ArgumentError);
  broken = embedding;
  broken.target.group_order = 60;
  EXPECT_THROW(PointLocator{broken}, ArgumentError);
}

const std::array<Space, 3> spaces = {Space::sphere(), Space::plane(), Space::hyperbolic_plane()};

// A triangle whose corners are within `width` of one geodesic.
TriangleCorners thin_triangle(Space space, std::mt19937& random, double length, double width) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const double reach = uniform(random), longitude = 6.3 * uniform(random);
  const Vector3 a = space.polar(space == Space::sphere() ? 3 * reach : reach, longitude);
  const Vector3 along =
      space.rotation(a, 6.3 * uniform(random)) * space.normal(Space::line(a, Vector3::UnitX()));
  const Vector3 middle = space.at(a, along, 0.4 * length), b = space.at(a, along, length);
  TriangleCorners corners = {a, b, space.at(middle, space.normal(Space::line(a, b)), width)};
  if (orientation_sign(corners[0], corners[1], corners[2]) < 0) std::swap(corners[1], corners[2]);
  return corners;
}

TEST(BarycentricCoordinates, PointsComeBackFromTrianglesHoweverThinOrSmall) {
  std::mt19937 random(3);
  for (const Space space : spaces)
    for (const double length : {1.5, 0.1, 1e-3, 1e-7})
      for (const double width : {1.0, 1e-3, 1e-6, 1e-10}) {
        for (int k = 0; k < 50; ++k) {
          const TriangleCorners corners = thin_triangle(space, random, length, length * width);
          if (orientation_sign(corners[0], corners[1], corners[2]) <= 0) continue;
          const Vector3 point = barycentric_point(space, corners, random_coordinates(random));
          const Vector3 coordinates = barycentric_coordinates(space, corners, point);
          EXPECT_GE(coordinates.minCoeff(), 0);
          EXPECT_NEAR(coordinates.sum(), 1, 1e-15);
          EXPECT_LE((barycentric_point(space, corners, coordinates) - point).norm(),
                    1e-14 * point.squaredNorm())
              << space.name() << " " << length << " " << width;
        }
      }
}

TEST(BarycentricCoordinates, TheFanOfAPointIsItsTriangleDivided) {
  std::mt19937 random(4);
  for (const Space space : spaces) {
    for (int k = 0; k < 200; ++k) {
      const TriangleCorners corners = thin_triangle(space, random, 1, 0.7);
      const Vector3 expected = random_coordinates(random),
                    point = barycentric_point(space, corners, expected);
      EXPECT_LE((barycentric_coordinates(space, corners, point) - expected).cwiseAbs().maxCoeff(), 2e-14);
      EXPECT_TRUE(triangle_contains(corners, point));
      EXPECT_FALSE(triangle_contains(corners, -point));
      EXPECT_FALSE(triangle_contains(corners, barycentric_point(space, corners, Vector3(0.7, 0.7, -0.4))));
      for (int c = 0; c < 3; ++c) {
        EXPECT_TRUE(triangle_contains(corners, corners[c]));
        EXPECT_LE((barycentric_coordinates(space, corners, corners[c]) - Vector3::Unit(c)).norm(), 4e-15);
      }
    }
  }
}

// In spaces that are not flat a long edge is not the straight line between its ends.
TEST(BarycentricCoordinates, TheNearestPointOfTheEdgesIsTheFootOfThePerpendicular) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (const Space space : spaces)
    for (const double length : {1.5, 0.1, 1e-3}) {
      for (int k = 0; k < 50; ++k) {
        const TriangleCorners corners = thin_triangle(space, random, length, 0.5 * length);
        const double t = uniform(random);
        const Vector3 on_edge = barycentric_point(space, corners, Vector3(1 - t, t, 0));
        const Vector3 beside =
            space.at(on_edge, space.normal(Space::line(corners[0], corners[1])), -1e-12 * length);
        const Vector3 found = nearest_on_edges(space, corners, beside);
        EXPECT_LE((barycentric_point(space, corners, found) - on_edge).norm(), 1e-14 * on_edge.squaredNorm())
            << space.name() << " " << length;
        EXPECT_NEAR(found[1], t, 1e-14 * on_edge.squaredNorm() / length) << space.name();
      }
    }
}

TEST(BarycentricCoordinates, TheBulgeBoundsHowFarTrianglesAreFromFlatOnes) {
  std::mt19937 random(5);
  for (const Space space : spaces) {
    for (int k = 0; k < 300; ++k) {
      const TriangleCorners corners = thin_triangle(space, random, 0.9, 0.5);
      const Vector3 l = random_coordinates(random);
      const Vector3 flat = l[0] * corners[0] + l[1] * corners[1] + l[2] * corners[2];
      EXPECT_LE((barycentric_point(space, corners, l) - flat).norm(), triangle_bulge(space, corners) + 1e-15)
          << space.name();
    }
  }
}

}  // namespace
}  // namespace orbitutte::point_map_test
