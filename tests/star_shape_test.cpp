// SPDX-License-Identifier: MIT
#include "orbitutte/solve/star_shape.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

namespace orbitutte::star_shape_test {
namespace {

constexpr double no_bound = std::numeric_limits<double>::infinity();

// A star with six triangles around the north pole, whose image and source are both a little random, and whose
// last triangle is flat in the source if one shall be.
StarShape random_star(std::mt19937& random, int flat_triangles) {
  std::uniform_real_distribution<double> length(0.6, 1.4);
  constexpr int count = 6;
  std::vector<Vector3> image, source;
  for (int k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * k / count;
    const Vector3 direction(std::cos(angle), std::sin(angle), 0);
    image.push_back(1e-2 * length(random) * direction);
    source.push_back(length(random) * direction);
  }
  if (flat_triangles == 1) source.front() = 0.5 * source.back();
  StarShape shape;
  shape.axes << 1, 0, 0, 1, 0, 0;
  const Vector3 p = Vector3::UnitZ();
  for (int k = 0; k < count; ++k) {
    StarShape::Triangle& triangle = shape.triangles.emplace_back();
    triangle.a = image[k];
    triangle.b = image[(k + 1) % count];
    triangle.value = p.dot(triangle.a.cross(triangle.b));
    triangle.gradient = p.cross(triangle.b - triangle.a) + triangle.a.cross(triangle.b);
    set_source(source[k], source[(k + 1) % count], triangle);
    shape.radius = std::max(shape.radius, triangle.a.norm());
  }
  return shape;
}

Vector3 random_step(std::mt19937& random) {
  std::uniform_real_distribution<double> part(-2e-3, 2e-3);
  return {part(random), part(random), 0};
}

TEST(StarShape, OneFaceIsFlatWhereTwoEdgesLieOnALine) {
  std::mt19937 random(1);
  int flat = 0;
  for (const StarShape::Triangle& triangle : random_star(random, 1).triangles)
    flat += triangle.is_flat ? 1 : 0;
  EXPECT_EQ(flat, 1);
}

TEST(StarShape, DistortionIsOneWhereTheMapIsASimilarity) {
  std::mt19937 random(2);
  StarShape shape = random_star(random, 0);
  for (StarShape::Triangle& triangle : shape.triangles) set_source(7 * triangle.a, 7 * triangle.b, triangle);
  EXPECT_NEAR(distortion(shape, Vector3::Zero(), no_bound), 6, 1e-6);
}

TEST(StarShape, DerivativesAgreeWithDifferences) {
  std::mt19937 random(3);
  for (int trial = 0; trial < 40; ++trial) {
    const StarShape shape = random_star(random, trial % 2);
    const Vector3 at = random_step(random);
    const DistortionDerivatives exact = derivatives_of_distortion(shape, at);
    for (int axis = 0; axis < 2; ++axis) {
      const double h = 1e-7;
      const Vector3 step = h * shape.axes.col(axis);
      const double slope =
          (distortion(shape, at + step, no_bound) - distortion(shape, at - step, no_bound)) / (2 * h);
      EXPECT_NEAR(exact.gradient[axis], slope, 1e-5 * (1 + exact.gradient.norm()));
      const Eigen::Vector2d change = (derivatives_of_distortion(shape, at + step).gradient -
                                      derivatives_of_distortion(shape, at - step).gradient) /
                                     (2 * h);
      EXPECT_LT((exact.hessian.col(axis) - change).norm(), 1e-5 * (1 + exact.hessian.norm()));
    }
  }
}

TEST(StarShape, NoPlaceNearbyIsMuchBetterThanTheLeast) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 40; ++trial) {
    const StarShape shape = random_star(random, trial % 2);
    const SmoothedStar found = least_distortion(shape);
    EXPECT_NEAR(found.distortion, distortion(shape, shape.axes * found.step, no_bound),
                1e-12 * found.distortion);
    for (int k = 0; k < 64; ++k) {
      const double angle = 2 * std::numbers::pi * k / 64;
      const Eigen::Vector2d there = found.step + 5e-4 * Eigen::Vector2d(std::cos(angle), std::sin(angle));
      EXPECT_GT(distortion(shape, shape.axes * there, no_bound), 0.995 * found.distortion);
    }
  }
}

TEST(StarShape, AVertexOnAMirrorMovesAlongIt) {
  std::mt19937 random(5);
  StarShape shape = random_star(random, 0);
  shape.on_mirror = true;
  const SmoothedStar found = least_distortion(shape);
  EXPECT_EQ(found.step.y(), 0);
  EXPECT_LE(found.distortion, distortion(shape, Vector3::Zero(), no_bound));
}

TEST(StarShape, AStarThatIsTurnedOverStays) {
  std::mt19937 random(6);
  StarShape shape = random_star(random, 0);
  for (StarShape::Triangle& triangle : shape.triangles) triangle.value = -triangle.value;
  const SmoothedStar found = least_distortion(shape);
  EXPECT_EQ(found.step, Eigen::Vector2d(0, 0));
  EXPECT_FALSE(std::isfinite(found.distortion));
}

}  // namespace
}  // namespace orbitutte::star_shape_test
