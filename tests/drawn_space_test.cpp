// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/drawn_space.h"

#include <gtest/gtest.h>

#include <vector>

namespace orbitutte::drawn_space_test {
namespace {

constexpr double disk_edge = 1;

const std::vector<Space> spaces = {Space::sphere(), Space::plane(), Space::hyperbolic_plane()};

std::vector<Vector3> points_around(Space space) {
  std::vector<Vector3> points;
  for (int k = 0; k < 12; ++k) points.push_back(space.polar(0.2 * k, 0.7 * k));
  return points;
}

TEST(DrawnSpace, ShowsThePointThatIsDrawnThere) {
  for (const Space space : spaces) {
    const DrawnSpace drawn(space, space.polar(0.8, 2));
    for (const Vector3& p : points_around(space)) {
      const std::optional<Vector3> seen = drawn.point_at(drawn.at(p));
      ASSERT_TRUE(seen.has_value());
      EXPECT_LT((*seen - p).norm(), 1e-12 * p.norm() * p.norm());
      EXPECT_LT(drawn.surface().defect(drawn.at(p)), 1e-14);
    }
  }
}

TEST(DrawnSpace, HasItsMiddleInTheMiddleOfTheDiskAndNothingBeyond) {
  const Space space = Space::hyperbolic_plane();
  const Vector3 middle = space.polar(1.5, 1);
  const DrawnSpace drawn(space, middle);
  EXPECT_LT((drawn.at(middle) - Space::origin()).norm(), 1e-12);
  for (const Vector3& p : points_around(space)) EXPECT_LT(drawn.at(p).head<2>().norm(), disk_edge);
  EXPECT_FALSE(drawn.point_at({disk_edge, 0, 1}).has_value());
}

TEST(DrawnSpace, LiesWithinTheBallThatHoldsItUnlessItHasNoEnd) {
  for (const Space space : spaces) {
    const DrawnSpace drawn(space, space.polar(0.8, 2));
    const auto whole = drawn.whole();
    EXPECT_EQ(whole.has_value(), space != Space::plane());
    for (const Vector3& p : points_around(space)) {
      if (whole) {
        EXPECT_LE((drawn.at(p) - whole->centre).norm(), whole->radius + 1e-15);
      }
    }
  }
}

// It is conformal: a short step is drawn with the same scale in all directions.
TEST(DrawnSpace, DrawsShortStepsAtItsScale) {
  constexpr double step = 1e-5;
  for (const Space space : spaces) {
    const DrawnSpace drawn(space, space.polar(0.5, -1));
    for (const Vector3& p : points_around(space))
      for (const Vector3& direction : {Vector3(1, 0, 0.3), Vector3(-0.2, 1, 0), Vector3(0.5, -0.7, 1)}) {
        const Vector3 tangent = space.tangent(p, direction);
        const Vector3 unit = tangent / space.norm(tangent);
        const double length = (drawn.at(space.at(p, unit, step)) - drawn.at(space.at(p, unit, -step))).norm();
        EXPECT_NEAR(length / (2 * step) / drawn.scale(p), 1, 1e-4);
      }
  }
}

}  // namespace
}  // namespace orbitutte::drawn_space_test
