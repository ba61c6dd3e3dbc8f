// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/spherical_triangle.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <random>

#include "hand_made.h"
#include "test_meshes.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

std::vector<Vector3> random_points(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  std::vector<Vector3> points;
  for (int k = 0; k < count; ++k)
    points.push_back(Vector3(normal(random), normal(random), normal(random)).normalized());
  return points;
}

// A point at the distance from p, in the direction of q.
Vector3 towards(const Vector3& p, const Vector3& q, double distance) {
  return std::cos(distance) * p + std::sin(distance) * (q - p * p.dot(q)).normalized();
}

double total_area(const Mesh& mesh) {
  double area = 0;
  for (int f = 0; f < test::face_count(mesh); ++f)
    area += signed_area(mesh.V.row(mesh.F(f, 0)), mesh.V.row(mesh.F(f, 1)), mesh.V.row(mesh.F(f, 2)));
  return area;
}

TEST(SphericalTriangle, OctantsAreEighthsOfTheSphere) {
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0})
        EXPECT_NEAR(signed_area({x, 0, 0}, {0, y, 0}, {0, 0, z}), x * y * z * pi / 2, 1e-15);
}

TEST(SphericalTriangle, ClosedMeshesHaveTheAreaOfTheSphere) {
  for (const Mesh& mesh : {test::icosphere(3), test::octasphere(2)})
    EXPECT_NEAR(total_area(mesh), 4 * pi, 1e-12);
}

TEST(SphericalTriangle, AreasOfTheTrianglesOfReflectionGroupsAreFractionsOfTheSphere) {
  for (const auto& [n, order] : {std::pair(3, 24), std::pair(4, 48), std::pair(5, 120)}) {
    const hand_made::Triangle t(2, 3, n);
    EXPECT_NEAR(std::abs(signed_area(t.a, t.b, t.c)), 4 * pi / order, 1e-14);
  }
}

TEST(SphericalTriangle, AreaIsAdditiveUnderSubdivision) {
  const std::vector<Vector3> p = random_points(900, 1);
  for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
    Vector3 a = p[k], b = p[k + 1], c = p[k + 2];
    if (a.dot(b.cross(c)) < 0) std::swap(b, c);
    const Vector3 inside = (0.2 * a + 0.3 * b + 0.5 * c).normalized();
    const double parts = signed_area(a, b, inside) + signed_area(b, c, inside) + signed_area(c, a, inside);
    EXPECT_NEAR(signed_area(a, b, c), parts, 1e-12);
    const Vector3 on_edge = (a + 0.7 * b).normalized();
    EXPECT_NEAR(signed_area(a, b, c), signed_area(a, on_edge, c) + signed_area(on_edge, b, c), 1e-12);
  }
}

TEST(SphericalTriangle, AreaChangesSignWithTheOrientationAndNotUnderRotation) {
  const std::vector<Vector3> p = random_points(600, 2);
  const Matrix3 R = hand_made::rotation({1, 2, 3}, 0.7), M = hand_made::reflection({3, -1, 2});
  for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
    const double area = signed_area(p[k], p[k + 1], p[k + 2]);
    EXPECT_NEAR(signed_area(p[k + 1], p[k], p[k + 2]), -area, 1e-13);
    EXPECT_NEAR(signed_area(p[k + 1], p[k + 2], p[k]), area, 1e-13);
    EXPECT_NEAR(signed_area(R * p[k], R * p[k + 1], R * p[k + 2]), area, 1e-12);
    EXPECT_NEAR(signed_area(M * p[k], M * p[k + 1], M * p[k + 2]), -area, 1e-12);
  }
}

TEST(SphericalTriangle, SmallTrianglesHaveTheAreaOfFlatOnes) {
  const Vector3 p = Vector3(1, -2, 3).normalized();
  const Vector3 u = p.unitOrthogonal(), v = p.cross(u);
  for (const double size : {1e-3, 1e-5, 1e-7}) {
    const double area = signed_area((p + size * u).normalized(), (p + size * v).normalized(),
                                    (p - size * (u + v)).normalized());
    EXPECT_NEAR(area, 1.5 * size * size, 1e-5 * size * size + 1e-15 * size) << size;
  }
}

TEST(SphericalTriangle, LengthIsAccurateNearZeroAndNearPi) {
  const Vector3 p = Vector3(1, 2, -1).normalized(), q = Vector3(0.3, -1, 2).normalized();
  for (const double distance : {0.0, 1e-12, 1e-8, 1e-4, 1.0, pi / 2, 3.0})
    EXPECT_NEAR(arc_length(p, towards(p, q, distance)), distance, 4e-16) << distance;
  for (const double short_of : {0.0, 1e-12, 1e-8, 1e-4, 1.0})
    EXPECT_NEAR(pi - arc_length(p, -towards(p, q, short_of)), short_of, 1e-15) << short_of;
  EXPECT_EQ(arc_length(p, p), 0);
  EXPECT_LE(arc_length(p, -p), pi);
}

TEST(SphericalTriangle, LengthIsAMetric) {
  const std::vector<Vector3> p = random_points(600, 3);
  for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
    EXPECT_EQ(arc_length(p[k], p[k + 1]), arc_length(p[k + 1], p[k]));
    EXPECT_LE(arc_length(p[k], p[k + 2]),
              arc_length(p[k], p[k + 1]) + arc_length(p[k + 1], p[k + 2]) + 1e-15);
    EXPECT_NEAR(arc_length(p[k], p[k + 1]) + arc_length(p[k], -p[k + 1]), pi, 1e-15);
  }
}

TEST(SphericalTriangle, AnglesExceedPiByTheArea) {
  const std::vector<Vector3> p = random_points(900, 4);
  for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
    Vector3 a = p[k], b = p[k + 1], c = p[k + 2];
    if (a.dot(b.cross(c)) < 0) std::swap(b, c);
    EXPECT_NEAR(angle_at(a, b, c) + angle_at(b, c, a) + angle_at(c, a, b) - pi, signed_area(a, b, c), 1e-12);
  }
}

TEST(SphericalTriangle, AnglesAroundAPointAddUpToAFullTurn) {
  const std::vector<Vector3> p = random_points(100, 5);
  for (const Vector3& centre : p) {
    const Vector3 u = centre.unitOrthogonal(), v = centre.cross(u);
    double sum = 0;
    for (int k = 0; k < 7; ++k) {
      const auto spoke = [&](int i) {
        const double angle = 2 * pi * (i % 7) / 7;
        return towards(centre, std::cos(angle) * u + std::sin(angle) * v, 0.1 + 0.3 * (i % 7));
      };
      EXPECT_NEAR(angle_at(centre, spoke(k), spoke(k + 1)), 2 * pi / 7, 1e-13);
      sum += angle_at(centre, spoke(k), spoke(k + 1));
    }
    EXPECT_NEAR(sum, 2 * pi, 1e-12);
  }
}

TEST(SphericalTriangle, AngleIsMeasuredCounterclockwise) {
  const Vector3 x = Vector3::UnitX(), y = Vector3::UnitY(), z = Vector3::UnitZ();
  EXPECT_NEAR(angle_at(z, x, y), pi / 2, 1e-15);
  EXPECT_NEAR(angle_at(z, y, x), -pi / 2, 1e-15);
  EXPECT_NEAR(angle_at(z, x, -x), pi, 1e-15);
  EXPECT_EQ(angle_at(z, x, x), 0);
}

}  // namespace
}  // namespace orbitutte
