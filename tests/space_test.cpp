// SPDX-License-Identifier: MIT
// The sphere, the plane and the hyperboloid: what holds for all three, and what is known of each.
#include "orbitutte/geometry/space.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>

#include "hand_made.h"
#include "orbitutte/geometry/fitted_rotation.h"
#include "orbitutte/geometry/morton.h"
#include "orbitutte/geometry/near_distance.h"
#include "orbitutte/geometry/orientation.h"
#include "orbitutte/geometry/precise_distance.h"
#include "orbitutte/geometry/stereographic_chart.h"
#include "test_meshes.h"

namespace orbitutte::space_test {
namespace {

using std::numbers::pi;

class EverySpace : public testing::TestWithParam<int> {
 protected:
  int k() const { return GetParam(); }
  Space space() const {
    return k() > 0 ? Space::sphere() : k() == 0 ? Space::plane() : Space::hyperbolic_plane();
  }
};

INSTANTIATE_TEST_SUITE_P(Geometry, EverySpace, testing::Values(1, 0, -1), [](const auto& info) {
  return info.param > 0 ? "sphere" : info.param == 0 ? "plane" : "hyperboloid";
});

// Points at distances below `reach` from (0, 0, 1), in all directions.
std::vector<Vector3> random_points(Space space, int count, std::uint32_t seed, double reach = 1.5) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(0, 1);
  std::vector<Vector3> points;
  for (int k = 0; k < count; ++k) {
    const double distance = reach * uniform(random);
    points.push_back(space.polar(distance, 2 * pi * uniform(random)));
  }
  return points;
}

// The unit tangent vector at p that makes this angle with some fixed direction there.
Vector3 unit_tangent(Space space, const Vector3& p, double angle) {
  const Vector3 u = space.tangent(p, {1, 0.3, 0.2}), first = u / space.norm(u);
  const Vector3 turned = space.rotation(p, angle) * first;
  return turned / space.norm(turned);
}

// Some that keep orientations and some that do not.
std::vector<Isometry> some_isometries(Space space) {
  const std::vector<Vector3> p = random_points(space, 8, 17);
  const Isometry turn = space.rotation(p[0], 0.7), other = space.rotation(p[1], -2.1);
  const Isometry mirror = space.reflection(Space::line(p[2], p[3]));
  return {
      Isometry(),           turn, other, mirror, turn * other, turn * mirror, mirror * other * turn.inverse(),
      space.to_origin(p[4])};
}

double sn(int k, double d) { return k > 0 ? std::sin(d) : k == 0 ? d : std::sinh(d); }
double cs(int k, double d) { return k > 0 ? std::cos(d) : k == 0 ? 1 : std::cosh(d); }

Precise sn_of(int k, const Precise& d) { return k > 0 ? Precise(sin(d)) : k == 0 ? d : Precise(sinh(d)); }

// --------------------------------------------------------------------------------------------------- points

TEST_P(EverySpace, PointsAreWhereTheEquationSays) {
  for (const Vector3& p : random_points(space(), 200, 1, 3)) {
    const double scale = p.squaredNorm();
    EXPECT_NEAR(k() * p.head<2>().squaredNorm() + p.z() * p.z(), 1, 4e-16 * scale);
    EXPECT_LE(space().defect(p), 4e-16 * scale);
    EXPECT_LE(space().defect(space().retract(3.7 * p)), 4e-16 * scale);
    EXPECT_LE((space().retract(3.7 * p) - p).norm(), 1e-15 * scale * p.norm());
    EXPECT_NEAR(space().distance(Space::origin(), space().polar(1.2, 0.4)), 1.2, 1e-15);
  }
  EXPECT_EQ(space().defect(Space::origin()), 0);
}

TEST_P(EverySpace, WhatIsOffTheSpaceIsSeen) {
  const Vector3 p = space().polar(0.8, 2);
  EXPECT_NEAR(space().defect(1.25 * p), 0.25, 1e-15);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
    EXPECT_EQ(space().defect({p.x(), p.y(), bad}), std::numeric_limits<double>::infinity());
  if (k() <= 0) {
    EXPECT_EQ(space().defect(-p), std::numeric_limits<double>::infinity()) << "the other sheet";
  }
}

TEST_P(EverySpace, FlatteningUndoesLifting) {
  for (const Vector3& p : random_points(space(), 50, 2)) {
    const Vector3 lifted = space().lift(p.x(), p.y());
    EXPECT_LE((lifted - p).norm(), 1e-14);
    EXPECT_EQ(space().flatten(lifted), p.head<2>());
  }
}

TEST_P(EverySpace, TangentVectorsAreTheDerivativesOfCurves) {
  const std::vector<Vector3> p = random_points(space(), 50, 3), v = random_points(space(), 50, 4);
  for (std::size_t i = 0; i < p.size(); ++i) {
    const Vector3 u = space().tangent(p[i], v[i]);
    EXPECT_LE((space().tangent(p[i], u) - u).norm(), 1e-13);
    EXPECT_LE(space().tangent(p[i], p[i]).norm(), 1e-13);
    EXPECT_LE(space().defect(space().retract(p[i] + 1e-4 * u)), 1e-14);
    // d/dt of k (x^2 + y^2) + z^2 is zero
    EXPECT_NEAR(k() * p[i].head<2>().dot(u.head<2>()) + p[i].z() * u.z(), 0, 1e-13);
  }
}

TEST_P(EverySpace, GeodesicsAreRunAtUnitSpeed) {
  for (const Vector3& p : random_points(space(), 40, 5, 1)) {
    const Vector3 u = unit_tangent(space(), p, p.x());
    for (const double d : {1e-12, 1e-8, 1e-4, 1e-3, 0.1, 1.0, 2.5}) {
      const Vector3 q = space().at(p, u, d);
      EXPECT_LE(space().defect(q), 1e-14 * q.squaredNorm());
      EXPECT_NEAR(space().distance(p, q), d, 1e-15 * p.squaredNorm() * q.norm()) << d;
    }
  }
}

TEST_P(EverySpace, TheMetricMakesCovectorsOfTangentVectors) {
  const std::vector<Vector3> p = random_points(space(), 30, 22), v = random_points(space(), 30, 23);
  Points rows(30, 3);
  for (int i = 0; i < 30; ++i) rows.row(i) = space().tangent(p[i], v[i]);
  Points lowered = rows;
  lower_rows(space(), lowered);
  for (int i = 0; i < 30; ++i) {
    const Vector3 u = unit_tangent(space(), p[i], 1), t = rows.row(i);
    EXPECT_NEAR(u.dot(space().metric().cwiseProduct(t)), space().dot(u, t), 1e-13);
    EXPECT_NEAR(lowered.row(i).dot(u), space().dot(u, t), 1e-13);
    EXPECT_NEAR(space().squared_norm(t), space().dot(t, t), 1e-13);
  }
}

TEST_P(EverySpace, TheFormIsTheEquationOfTheSpaceAndTheCosineOfDistances) {
  const std::vector<Vector3> p = random_points(space(), 60, 24);
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
    EXPECT_NEAR(space().form(p[i], p[i]), 1, 1e-14);
    EXPECT_NEAR(space().form(p[i], p[i + 1]), cs(k(), space().distance(p[i], p[i + 1])), 1e-13);
    EXPECT_NEAR(space().form(p[i], unit_tangent(space(), p[i], 0.4)), 0, 1e-13);
  }
}

TEST_P(EverySpace, TheSideTellsAPointFromItsOpposite) {
  const std::vector<Vector3> p = random_points(space(), 60, 25);
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
    if (space().distance(p[i], p[i + 1]) > 1.5) continue;
    const Vector3 there = p[i] + p[i + 1];
    EXPECT_GT(space().side(p[i], there), 0);
    EXPECT_LT(space().side(Vector3(-p[i]), there), 0);
  }
  // Far from the edge's middle, as no point of the sphere can be, it is still the point and not its opposite.
  const Vector3 far = space().lift(-8, 0), near = space().lift(0.1, 0);
  if (k() <= 0) {
    EXPECT_GT(space().side(near, Vector3(near + far)), 0);
  }
}

TEST_P(EverySpace, TurningLeftIsTheRotationByARightAngle) {
  for (const Vector3& p : random_points(space(), 40, 26)) {
    const Vector3 u = unit_tangent(space(), p, p.y()), left = space().turned_left(p, u);
    EXPECT_LE((left - space().rotation(p, pi / 2) * u).norm(), 1e-13);
    EXPECT_NEAR(space().dot(u, left), 0, 1e-13);
  }
}

// A vector that moves along a geodesic keeps its length and its angle with the geodesic.
TEST_P(EverySpace, VectorsAreMovedAlongGeodesics) {
  for (const Vector3& p : random_points(space(), 30, 27)) {
    const Vector3 u = unit_tangent(space(), p, 0.3), v = 2 * unit_tangent(space(), p, 1.1);
    const double d = 1.2;
    const Vector3 q = space().at(p, u, d), ahead = space().at(p, u, d + 1e-3) - q;
    const Vector3 moved = space().moved_along(v, p, q), direction = space().tangent(q, ahead).normalized();
    EXPECT_LE((space().tangent(q, moved) - moved).norm(), 1e-12 * q.norm());
    EXPECT_NEAR(space().norm(moved), 2, 1e-12);
    EXPECT_NEAR(space().dot(moved, direction / space().norm(direction)), 2 * std::cos(0.8), 1e-9);
    EXPECT_LE((space().moved_along(v, p, p) - v).norm(), 1e-13) << "a step of no length changes nothing";
  }
}

TEST_P(EverySpace, LengthsFollowFromSnOfTheirHalf) {
  for (const double d : {1e-9, 0.1, 1.0, 3.0})
    EXPECT_NEAR(space().length_of_half_sn(sn(k(), d / 2)) / d, 1, 1e-14);
  if (k() > 0) {
    EXPECT_EQ(space().length_of_half_sn(1.5), pi);
  }
}

// What is said of a space by its name is what its formulas do.
TEST_P(EverySpace, SimilaritiesAreThereWhereSidesDoNotFollowFromAngles) {
  // With the angles of a triangle whose sides are not small, twice its sides make other angles unless there
  // are similarities.
  const Vector3 a = Space::origin(), b = space().polar(0.6, 0), c = space().polar(0.6, 1);
  const Vector3 b2 = space().polar(1.2, 0), c2 = space().polar(1.2, 1);
  const double change = std::abs(space().angle(b, c, a) - space().angle(b2, c2, a));
  EXPECT_EQ(space().has_similarities(), change < 1e-9);
}

TEST_P(EverySpace, DistancesAreConvexWhereTheCurvatureIsNotPositive) {
  const std::vector<Vector3> p = random_points(space(), 200, 28, 1.5);
  bool is_convex = true;
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
    const Vector3 u = unit_tangent(space(), p[i], 0.3), v = unit_tangent(space(), p[i + 1], 2.1);
    const auto distance = [&](double t) {
      return space().distance(space().at(p[i], u, t), space().at(p[i + 1], v, t));
    };
    is_convex = is_convex && distance(0.4) <= (distance(0) + distance(0.8)) / 2 + 1e-12;
  }
  EXPECT_EQ(is_convex, space().has_convex_distances());
}

// ---------------------------------------------------------------------------------------------- orientation

TEST_P(EverySpace, TheSignOfTheDeterminantIsTheOrientation) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> uniform(0, 1);
  const std::vector<Isometry> isometries = some_isometries(space());
  for (int i = 0; i < 200; ++i) {
    const double from = 6 * uniform(random), to = from + 3 * uniform(random) + 0.05;
    const Vector3 a = Space::origin(), b = space().polar(0.1 + uniform(random), from),
                  c = space().polar(0.1 + uniform(random), to);
    EXPECT_EQ(orientation_sign(a, b, c), 1);
    EXPECT_GT(space().area(a, b, c), 0);
    for (const Isometry& g : isometries) {
      const int sign = g.reverses_orientation() ? -1 : 1;
      EXPECT_EQ(orientation_sign(g * a, g * b, g * c), sign);
      EXPECT_EQ(space().area(g * a, g * b, g * c) > 0, sign > 0);
    }
  }
}

// ----------------------------------------------------------------------------------------------- isometries

TEST_P(EverySpace, IsometriesKeepDistancesAreasAndAngles) {
  const std::vector<Vector3> p = random_points(space(), 90, 7);
  for (const Isometry& g : some_isometries(space())) {
    EXPECT_LE(space().isometry_defect(g.matrix()), 1e-12);
    const int sign = g.reverses_orientation() ? -1 : 1;
    for (std::size_t i = 0; i + 2 < p.size(); i += 3) {
      const Vector3 &a = p[i], &b = p[i + 1], &c = p[i + 2];
      EXPECT_LE(space().defect(g * a), 1e-12);
      EXPECT_NEAR(space().distance(g * a, g * b), space().distance(a, b), 1e-12);
      EXPECT_NEAR(space().area(g * a, g * b, g * c), sign * space().area(a, b, c), 1e-12);
      EXPECT_NEAR(space().angle(g * a, g * b, g * c), sign * space().angle(a, b, c), 1e-10);
    }
  }
}

TEST_P(EverySpace, IsometriesComposeAndInvert) {
  const Vector3 p = random_points(space(), 1, 8).front();
  for (const Isometry& g : some_isometries(space())) {
    EXPECT_LE((g * g.inverse()).difference({}), 1e-12);
    EXPECT_LE((g.inverse() * g).difference({}), 1e-12);
    EXPECT_LE(space().isometry(g.matrix()).inverse().difference(g.inverse()), 1e-12)
        << "the inverse follows from the matrix";
    EXPECT_LE((g.inverse() * (g * p) - p).norm(), 1e-12);
    EXPECT_EQ(g.inverse_matrix(), g.inverse().matrix());
    for (const Isometry& h : some_isometries(space())) {
      EXPECT_LE(((g * h) * p - g * (h * p)).norm(), 1e-12);
      EXPECT_LE((g * h).inverse().difference(h.inverse() * g.inverse()), 1e-15);
      EXPECT_EQ((g * h).reverses_orientation(), g.reverses_orientation() != h.reverses_orientation());
    }
  }
  EXPECT_TRUE(Isometry().is_identity());
}

TEST_P(EverySpace, IsometriesMoveRowsAsTheyMovePoints) {
  const std::vector<Vector3> p = random_points(space(), 10, 9);
  Points rows(10, 3);
  for (int i = 0; i < 10; ++i) rows.row(i) = p[i];
  for (const Isometry& g : some_isometries(space()))
    for (int i = 0; i < 10; ++i) EXPECT_LE((g.on_rows(rows).row(i).transpose() - g * p[i]).norm(), 1e-14);
}

TEST_P(EverySpace, WhatIsNoIsometryIsSeen) {
  const Matrix3 M = space().rotation(random_points(space(), 1, 10).front(), 0.9).matrix();
  EXPECT_LE(space().isometry_defect(M), 1e-14);
  EXPECT_GE(space().isometry_defect(2 * M), 0.9);
  EXPECT_GE(space().isometry_defect((1 + 1e-6) * M), 9e-7);
  Matrix3 sheared = M;
  sheared(0, 1) += 1e-3;
  EXPECT_GE(space().isometry_defect(sheared), 1e-4);
  EXPECT_GE(space().isometry_defect(Matrix3::Zero()), 0.9);
  for (const double bad :
       {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    Matrix3 broken = M;
    broken(2, 1) = bad;
    EXPECT_EQ(space().isometry_defect(broken), std::numeric_limits<double>::infinity());
  }
  // the antipodal map is one of the sphere only
  EXPECT_EQ(space().isometry_defect(-Matrix3::Identity()) < 1e-15, k() > 0);
  Matrix3 lifted = M;
  lifted(2, 0) += 0.1;
  EXPECT_GE(space().isometry_defect(lifted), 0.01);
}

TEST_P(EverySpace, TheNearestIsometryIsOneAndNear) {
  for (const Isometry& g : some_isometries(space())) {
    Matrix3 off = g.matrix();
    off.topRows<2>() += 1e-6 * Matrix3::Random().topRows<2>();
    if (k() != 0) off.row(2) += 1e-6 * Eigen::RowVector3d::Random();
    const Isometry nearest = space().nearest_isometry(off);
    EXPECT_LE(space().isometry_defect(nearest.matrix()), 1e-9);
    EXPECT_LE(nearest.difference(g), 1e-4);
  }
}

TEST_P(EverySpace, RotationsLeaveTheirPointAndTurnByTheirAngle) {
  const std::vector<Vector3> p = random_points(space(), 40, 11);
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    for (const double angle : {0.3, -1.9, 3.0}) {
      const Isometry turn = space().rotation(p[i], angle);
      EXPECT_LE((turn * p[i] - p[i]).norm(), 1e-13);
      EXPECT_NEAR(space().angle(p[i], p[i + 1], turn * p[i + 1]), angle, 1e-11);
      EXPECT_LE((space().rotation(p[i], 2 * angle)).difference(turn * turn), 1e-12);
      EXPECT_FALSE(turn.reverses_orientation());
    }
  }
}

TEST_P(EverySpace, ReflectionsLeaveTheirLineAndExchangeItsSides) {
  const std::vector<Vector3> p = random_points(space(), 60, 12);
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) {
    const Vector3 line = Space::line(p[i], p[i + 1]), q = p[i + 2];
    const Isometry mirror = space().reflection(line);
    EXPECT_LE((mirror * p[i] - p[i]).norm(), 1e-11);
    EXPECT_LE((mirror * p[i + 1] - p[i + 1]).norm(), 1e-11);
    EXPECT_NEAR(line.dot(mirror * q), -line.dot(q), 1e-11);
    EXPECT_LE((mirror * mirror).difference({}), 1e-11);
    EXPECT_TRUE(mirror.reverses_orientation());
    EXPECT_LE(space().isometry_defect(mirror.matrix()), 1e-11);
  }
}

TEST_P(EverySpace, NormalsOfLinesAreUnitTangentsTowardsTheLeft) {
  const std::vector<Vector3> p = random_points(space(), 60, 13);
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
    const Vector3 line = Space::line(p[i], p[i + 1]), n = space().normal(line);
    EXPECT_NEAR(space().norm(n), 1, 1e-12);
    for (const Vector3& q : {p[i], p[i + 1]}) {
      EXPECT_NEAR(line.dot(q), 0, 1e-13);
      EXPECT_LE((space().tangent(q, n) - n).norm(), 1e-10);
      EXPECT_GT(line.dot(space().at(q, n, 0.1)), 0);
      EXPECT_EQ(orientation_sign(p[i], p[i + 1], space().at(q, n, 0.1)), 1);
    }
    EXPECT_NEAR(space().dot(n, space().tangent(p[i], p[i + 1] - p[i])), 0, 1e-11);
  }
}

TEST_P(EverySpace, ThereIsAnIsometryThatTakesAnyPointToTheOrigin) {
  std::vector<Vector3> points = random_points(space(), 50, 14, 3);
  points.push_back(Space::origin());
  for (const Vector3& p : points) {
    const Isometry g = space().to_origin(p);
    EXPECT_LE((g * p - Space::origin()).norm(), 1e-14 * p.squaredNorm() * p.norm());
    EXPECT_FALSE(g.reverses_orientation());
    EXPECT_LE(space().isometry_defect(g.matrix()), 1e-14 * p.squaredNorm() * p.squaredNorm());
  }
  if (k() > 0) {
    EXPECT_LE((space().to_origin(-Space::origin()) * -Space::origin() - Space::origin()).norm(), 1e-15);
  }
}

TEST(MortonsCurve, VisitsTheEightCellsOfEachCubeBeforeTheNext) {
  EXPECT_EQ(place_on_curve(0, 0, 0), 0U);
  EXPECT_EQ(place_on_curve(1, 0, 0), 1U);
  EXPECT_EQ(place_on_curve(0, 1, 0), 2U);
  EXPECT_EQ(place_on_curve(0, 0, 1), 4U);
  constexpr std::uint64_t largest = (1U << 21) - 1;
  EXPECT_EQ(place_on_curve(largest, largest, largest), (std::uint64_t{1} << 63) - 1);
  std::mt19937 random(29);
  for (int i = 0; i < 200; ++i) {
    const std::uint64_t x = random() >> 12, y = random() >> 12, z = random() >> 12;
    EXPECT_EQ(place_on_curve(x, y, z) >> 3, place_on_curve(x >> 1, y >> 1, z >> 1));
  }
}

TEST(FittedRotation, IsTheOneThatTheOtherPointsWereTurnedBy) {
  const Isometry turn = Space::sphere().rotation(Vector3(1, 2, 2) / 3, 1.1);
  const Points from = Points::Random(20, 3), to = turn.on_rows(from);
  const FittedRotation found = fitted_rotation(from, to);
  EXPECT_LE((found.matrix - turn.matrix()).norm(), 1e-13);
  EXPECT_GT(found.certainty, 0.1);
  // Of mirror images it is still a rotation, the best one.
  const Points mirrored = to * Vector3(1, 1, -1).asDiagonal();
  EXPECT_NEAR(fitted_rotation(from, mirrored).matrix.determinant(), 1, 1e-13);
  const Points on_line = from.col(0) * Eigen::RowVector3d(1, 2, 3);
  EXPECT_LE(fitted_rotation(on_line, on_line).certainty, 1e-13) << "a line may be turned about itself";
}

// ------------------------------------------------------------------------------------------------- unknowns

TEST_P(EverySpace, TheRoomIsTheDirectionsInWhichPointsDiffer) {
  const Room room = space().room();
  EXPECT_EQ(room.cols(), k() == 0 ? 2 : 3);
  const std::vector<Vector3> p = random_points(space(), 20, 15);
  for (std::size_t i = 0; i + 1 < p.size(); ++i) {
    const Vector3 difference = p[i + 1] - p[i];
    EXPECT_LE((room * (room.transpose() * difference) - difference).norm(), 1e-15);
  }
}

TEST_P(EverySpace, TheRoomOnAMirrorIsWhatTheReflectionLeaves) {
  const std::vector<Vector3> p = random_points(space(), 60, 16);
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
    const Isometry mirror = space().reflection(Space::line(p[i], p[i + 1]));
    const Room room = space().room_on(mirror);
    EXPECT_EQ(room.cols(), space().room().cols() - 1);
    EXPECT_LE((room.transpose() * room - Eigen::MatrixXd::Identity(room.cols(), room.cols())).norm(), 1e-14);
    EXPECT_LE((mirror.matrix() * room - room).norm(), 1e-11);
    const Vector3 difference = p[i + 1] - p[i];
    EXPECT_LE((room * (room.transpose() * difference) - difference).norm(), 1e-12);
  }
}

TEST_P(EverySpace, ManyPointsAreMovedAndRetractedAsOneIs) {
  const std::vector<Vector3> p = random_points(space(), 30, 18), v = random_points(space(), 30, 19);
  Points positions(30, 3), directions(30, 3), moved;
  for (int i = 0; i < 30; ++i) positions.row(i) = p[i], directions.row(i) = space().tangent(p[i], v[i]);
  move_points(space(), positions, directions, 0.01, moved);
  Points retracted = 1.5 * positions;
  retract_points(space(), retracted);
  for (int i = 0; i < 30; ++i) {
    const Vector3 step = 0.01 * space().tangent(p[i], v[i]);
    const double length = space().norm(step);
    const Vector3 expected = space() == Space::hyperbolic_plane()
                                 ? Vector3(std::hypot(1, length) * p[i] + step)
                                 : space().retract(p[i] + step);
    EXPECT_LE((moved.row(i).transpose() - expected).norm(), 1e-13 * expected.norm());
    EXPECT_LE((retracted.row(i).transpose() - p[i]).norm(), 1e-14);
  }
}

// ------------------------------------------------------------------------------------------------- distance

struct Reference {
  long double squared, over_sn;
};

// From the squared chord of the stored points, in long double: c = 4 sn^2(d/2).
Reference reference(int k, const Vector3& p, const Vector3& q) {
  const long double dx = static_cast<long double>(p.x()) - q.x(),
                    dy = static_cast<long double>(p.y()) - q.y(),
                    dz = static_cast<long double>(p.z()) - q.z();
  const long double half = std::sqrt(dx * dx + dy * dy + k * dz * dz) / 2;
  if (k == 0) return {4 * half * half, 1};
  const long double d = 2 * (k > 0 ? std::asin(half) : std::asinh(half));
  return {d * d, d / (k > 0 ? std::sin(d) : std::sinh(d))};
}

template <int k>
void expect_series_agrees() {
  const Space space = k > 0 ? Space::sphere() : k == 0 ? Space::plane() : Space::hyperbolic_plane();
  const Vector3 p = space.polar(0.3, 1), u = unit_tangent(space, p, 0.7);
  for (double d = 1e-9; d < 2.8; d *= 1.07) {
    const Vector3 q = space.at(p, u, d);
    const auto found = Curvature<k>::distance(p, q);
    const Reference expected = reference(k, p, q);
    EXPECT_NEAR(static_cast<double>(found.squared / expected.squared), 1, 2e-15) << d;
    EXPECT_NEAR(static_cast<double>(found.over_sn / expected.over_sn), 1, 1e-14) << d;
  }
  EXPECT_EQ(Curvature<k>::distance(p, p).squared, 0);
  EXPECT_EQ(Curvature<k>::distance(p, p).over_sn, 1);
}

TEST(StereographicChart, PicturesPointsAndTangentVectors) {
  for (const Space space : {Space::sphere(), Space::plane(), Space::hyperbolic_plane()}) {
    const Vector3 centre = space.polar(0.4, 2);
    const StereographicChart chart(space, centre);
    EXPECT_LT(chart.flat(centre).norm(), 1e-15);
    for (int i = 0; i < 20; ++i) {
      const Vector3 p = space.polar(0.07 * i, 0.6 * i), flat = chart.flat(p), v(0.3, -0.4, 0);
      EXPECT_LT((chart.point(flat) - p).norm(), 1e-13);
      constexpr double step = 1e-5;
      const Vector3 difference = (chart.point(flat + step * v) - chart.point(flat - step * v)) / (2 * step);
      EXPECT_LT((chart.tangent(flat, v) - difference).norm(), 1e-8);
      // Conformal: the same factor in all directions.
      const double along = space.norm(chart.tangent(flat, v)),
                   across = space.norm(chart.tangent(flat, Vector3(0.4, 0.3, 0)));
      EXPECT_NEAR(along / across, 1, 1e-12);
    }
  }
}

template <int k>
void expect_near_series_agrees() {
  const Space space = k > 0 ? Space::sphere() : k == 0 ? Space::plane() : Space::hyperbolic_plane();
  const Vector3 p = space.polar(0.3, 1), u = unit_tangent(space, p, 0.7);
  const double farthest = 0.99 * std::sqrt(NearDistance<k>::farthest);
  for (double d = farthest; d > 1e-9; d *= 0.93) {
    const Vector3 q = space.at(p, u, d);
    const double squared_chord = Curvature<k>::dot(q - p, q - p);
    ASSERT_LT(squared_chord, NearDistance<k>::farthest);
    const DistanceFactors found = NearDistance<k>::factors(squared_chord);
    const Reference expected = reference(k, p, q);
    EXPECT_NEAR(found[0], static_cast<double>(expected.over_sn), 1e-15) << d;
    EXPECT_NEAR(static_cast<double>(found[1] * squared_chord / expected.squared), 1, 2e-15) << d;
  }
}

TEST(DistanceSeries, OfNearPointsAgreesWithTheFormulas) {
  expect_near_series_agrees<1>();
  expect_near_series_agrees<0>();
  expect_near_series_agrees<-1>();
}

TEST(DistanceSeries, AgreesWithTheFormulasAtAllScales) {
  expect_series_agrees<1>();
  expect_series_agrees<0>();
  expect_series_agrees<-1>();
}

// s = sn^2(d/2) is where one formula gives way to another.
template <int k>
void expect_no_step_at(double s) {
  const Space space = k > 0 ? Space::sphere() : Space::hyperbolic_plane();
  const double d = 2 * (k > 0 ? std::asin(std::sqrt(s)) : std::asinh(std::sqrt(s))), width = 1e-9 * d;
  const auto at = [&](double distance) {
    return Curvature<k>::distance(Space::origin(), space.polar(distance, 0.9));
  };
  const auto before = at(d - width), after = at(d + width);
  EXPECT_NEAR(before.squared / (d * d), 1 - 2e-9, 2e-15);
  EXPECT_NEAR(after.squared / (d * d), 1 + 2e-9, 2e-15);
  EXPECT_NEAR(before.over_sn, after.over_sn, 1e-9 * d * d + 1e-15);
}

TEST(DistanceSeries, HasNoStepsWhereTheFormulasChange) {
  for (const double s : {0x1p-13, 0x1p-6}) {
    expect_no_step_at<1>(s);
    expect_no_step_at<-1>(s);
  }
}

TEST(DistanceSeries, TurnsALineSearchBackBeforeAntipodes) {
  const auto antipodes = Curvature<1>::distance(Vector3::UnitX(), -Vector3::UnitX());
  EXPECT_NEAR(antipodes.squared, pi * pi, 1e-14);
  EXPECT_GT(antipodes.over_sn, 1e6);
  EXPECT_TRUE(std::isfinite(antipodes.over_sn));
}

template <int k>
void expect_gradient_of_squared_distance() {
  const Space space = k > 0 ? Space::sphere() : k == 0 ? Space::plane() : Space::hyperbolic_plane();
  const std::vector<Vector3> p = random_points(space, 60, 20, 1);
  for (std::size_t i = 0; i + 1 < p.size(); i += 2) {
    for (const double angle : {0.2, 1.9}) {
      const Vector3 u = unit_tangent(space, p[i], angle);
      const double h = 1e-5;
      const auto squared = [&](double t) {
        return Curvature<k>::distance(space.at(p[i], u, t), p[i + 1]).squared;
      };
      const double difference = (squared(h) - squared(-h)) / (2 * h);
      const auto d = Curvature<k>::distance(p[i], p[i + 1]);
      const Vector3 gradient = -2 * d.over_sn * Curvature<k>::tangent(p[i], p[i + 1] - p[i]);
      EXPECT_NEAR(Curvature<k>::dot(gradient, u), difference, 1e-9);
    }
  }
}

TEST(DistanceSeries, GivesTheGradientOfTheSquaredDistance) {
  expect_gradient_of_squared_distance<1>();
  expect_gradient_of_squared_distance<0>();
  expect_gradient_of_squared_distance<-1>();
}

template <int k>
void expect_slope_of_over_sn() {
  const Space space = k > 0 ? Space::sphere() : k == 0 ? Space::plane() : Space::hyperbolic_plane();
  for (const double d : {1e-3, 0.05, 0.099, 0.101, 0.5, 1.5}) {
    const auto chord = [](double x) { return 4 * std::pow(sn(k, x / 2), 2); };
    const double h = 1e-3 * d;
    const auto at = [&](double x) {
      return static_cast<double>(reference(k, Space::origin(), space.polar(x, 0.4)).over_sn);
    };
    const double expected = (at(d + h) - at(d - h)) / (chord(d + h) - chord(d - h));
    EXPECT_NEAR(Curvature<k>::slope_of_over_sn(chord(d), at(d)), expected, 1e-5 + 1e-9 / (d * d)) << d;
  }
}

TEST(DistanceSeries, HasTheSlopeOfItsSecondPart) {
  expect_slope_of_over_sn<1>();
  expect_slope_of_over_sn<0>();
  expect_slope_of_over_sn<-1>();
}

// As many digits as are asked for: the sum of the series against the formula in the same numbers.
template <int k>
void expect_precise_over_sn() {
  const Space space = k > 0 ? Space::sphere() : k == 0 ? Space::plane() : Space::hyperbolic_plane();
  for (const double d : {1e-30, 1e-3, 0.3, 1.0}) {
    const Precise half = sn_of(k, Precise(d) / 2), s = 4 * half * half;
    const Precise expected = k == 0 ? Precise(1) : Precise(Precise(d) / sn_of(k, Precise(d)));
    const Precise found = precise_over_sn<Precise>(space, s, 1e-60);
    EXPECT_LE(static_cast<double>(abs(found - expected)), 1e-58) << d;
  }
}

TEST(DistanceSeries, HasAsManyDigitsAsAreAskedFor) {
  expect_precise_over_sn<1>();
  expect_precise_over_sn<0>();
  expect_precise_over_sn<-1>();
}

TEST_P(EverySpace, DistanceIsAMetric) {
  const std::vector<Vector3> p = random_points(space(), 300, 21);
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) {
    EXPECT_EQ(space().distance(p[i], p[i]), 0);
    EXPECT_EQ(space().distance(p[i], p[i + 1]), space().distance(p[i + 1], p[i]));
    EXPECT_LE(space().distance(p[i], p[i + 2]),
              space().distance(p[i], p[i + 1]) + space().distance(p[i + 1], p[i + 2]) + 1e-14);
    visit_curvature(space(), [&](auto c) {
      const double d = space().distance(p[i], p[i + 1]);
      EXPECT_NEAR(c.distance(p[i], p[i + 1]).squared, d * d, 1e-14);
    });
  }
}

// ----------------------------------------------------------------------------------------- areas and angles

TEST_P(EverySpace, AnglesExceedPiByTheCurvatureTimesTheArea) {
  const std::vector<Vector3> p = random_points(space(), 900, 22, 1.4);
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) {
    Vector3 a = p[i], b = p[i + 1], c = p[i + 2];
    if (orientation_sign(a, b, c) < 0) std::swap(b, c);
    const double sum = space().angle(a, b, c) + space().angle(b, c, a) + space().angle(c, a, b);
    EXPECT_NEAR(sum - pi, k() * space().area(a, b, c), 1e-10);
  }
}

TEST_P(EverySpace, AreasAddUp) {
  const std::vector<Vector3> p = random_points(space(), 900, 23);
  for (std::size_t i = 0; i + 2 < p.size(); i += 3) {
    Vector3 a = p[i], b = p[i + 1], c = p[i + 2];
    if (orientation_sign(a, b, c) < 0) std::swap(b, c);
    const Vector3 inside = space().retract(0.2 * a + 0.3 * b + 0.5 * c),
                  on_edge = space().retract(a + 0.7 * b);
    const auto area = [&](const Vector3& x, const Vector3& y, const Vector3& z) {
      return space().area(x, y, z);
    };
    EXPECT_NEAR(area(a, b, c), area(a, b, inside) + area(b, c, inside) + area(c, a, inside), 1e-12);
    EXPECT_NEAR(area(a, b, c), area(a, on_edge, c) + area(on_edge, b, c), 1e-12);
    EXPECT_NEAR(area(b, a, c), -area(a, b, c), 1e-12);
    EXPECT_NEAR(area(b, c, a), area(a, b, c), 1e-12);
  }
}

// 2 pi k (1 - cs r) = 4 pi sn^2(r/2).
TEST_P(EverySpace, DisksHaveTheAreaThatTheirRadiusSays) {
  const int n = 4000;
  for (const double r : {0.1, 1.0, 1.5}) {
    double area = 0;
    for (int i = 0; i < n; ++i)
      area += space().area(Space::origin(), space().polar(r, 2 * pi * i / n),
                           space().polar(r, 2 * pi * (i + 1) / n));
    EXPECT_NEAR(area / (4 * pi * std::pow(sn(k(), r / 2), 2)), 1, 1e-5) << r;
  }
}

TEST_P(EverySpace, AnglesAroundAPointAddUpToAFullTurn) {
  for (const Vector3& centre : random_points(space(), 60, 24)) {
    double sum = 0;
    for (int i = 0; i < 7; ++i) {
      const auto spoke = [&](int j) {
        return space().at(centre, unit_tangent(space(), centre, 2 * pi * (j % 7) / 7), 0.1 + 0.2 * (j % 7));
      };
      EXPECT_NEAR(space().angle(centre, spoke(i), spoke(i + 1)), 2 * pi / 7, 1e-11);
      sum += space().angle(centre, spoke(i), spoke(i + 1));
    }
    EXPECT_NEAR(sum, 2 * pi, 1e-11);
  }
}

TEST_P(EverySpace, AnglesAreMeasuredCounterclockwise) {
  const Vector3 z = Space::origin(), x = space().polar(0.7, 0), y = space().polar(0.9, pi / 2),
                opposite = space().polar(0.5, pi);
  EXPECT_NEAR(space().angle(z, x, y), pi / 2, 1e-15);
  EXPECT_NEAR(space().angle(z, y, x), -pi / 2, 1e-15);
  EXPECT_NEAR(space().angle(z, x, opposite), pi, 1e-15);
  EXPECT_EQ(space().angle(z, x, x), 0);
}

// Angles pi/n: their sum is above, at and below pi.
std::vector<std::array<int, 3>> triangles_of(int k) {
  if (k > 0) return {{2, 3, 5}, {5, 3, 2}, {2, 2, 7}, {3, 3, 2}, {2, 4, 3}};
  if (k == 0) return {{3, 3, 3}, {2, 4, 4}, {4, 2, 4}, {6, 3, 2}};
  return {{2, 3, 7}, {7, 3, 2}, {4, 4, 4}, {3, 4, 5}, {2, 5, 5}, {9, 9, 9}};
}

TEST_P(EverySpace, TrianglesWithGivenAnglesHaveTheSidesOfTheLawOfCosines) {
  for (const auto& n : triangles_of(k())) {
    const double a = pi / n[0], b = pi / n[1], c = pi / n[2];
    const Vector3 A = Space::origin(), B = space().polar(space().side_opposite(c, a, b), 0),
                  C = space().polar(space().side_opposite(b, c, a), a);
    EXPECT_NEAR(space().angle(A, B, C), a, 1e-12);
    EXPECT_NEAR(space().angle(B, C, A), b, 1e-12);
    EXPECT_NEAR(space().angle(C, A, B), c, 1e-12);
    EXPECT_NEAR(space().distance(B, C), space().side_opposite(a, b, c), 1e-12);
    if (k() != 0) {
      EXPECT_NEAR(space().area(A, B, C), k() * (a + b + c - pi), 1e-12);
    }
  }
}

TEST_P(EverySpace, SidesAndAnglesFollowTheLawOfCosinesForSides) {
  for (const double b : {0.2, 0.7, 1.1}) {
    for (const double c : {0.3, 1.2}) {
      for (const double alpha : {0.4, 1.5, 2.8}) {
        const double a = space().distance(space().polar(c, 0), space().polar(b, alpha));
        if (k() == 0) {
          EXPECT_NEAR(a * a, b * b + c * c - 2 * b * c * std::cos(alpha), 1e-14);
        } else {
          EXPECT_NEAR(cs(k(), a), cs(k(), b) * cs(k(), c) + k() * sn(k(), b) * sn(k(), c) * std::cos(alpha),
                      1e-14);
        }
      }
    }
  }
}

// ------------------------------------------------------------------------------------------- all three alike

TEST(Spaces, AgreeOnSmallTriangles) {
  for (const double size : {1e-2, 1e-3, 1e-5}) {
    const auto corners = [&](Space space) {
      return std::array<Vector3, 3>{space.polar(size, 0.1), space.polar(2 * size, 1.3),
                                    space.polar(1.5 * size, 4)};
    };
    const auto [a, b, c] = corners(Space::plane());
    const Space plane = Space::plane();
    for (const Space space : {Space::sphere(), Space::hyperbolic_plane()}) {
      const auto [p, q, r] = corners(space);
      const double bound = 10 * size * size;
      EXPECT_NEAR(space.distance(p, q) / plane.distance(a, b), 1, bound);
      EXPECT_NEAR(space.area(p, q, r) / plane.area(a, b, c), 1, bound);
      EXPECT_NEAR(space.angle(p, q, r), plane.angle(a, b, c), bound);
    }
  }
}

TEST(Spaces, PointsThatRoundingAloneTellsApartHaveADistance) {
  for (const Space space : {Space::sphere(), Space::plane(), Space::hyperbolic_plane()}) {
    for (int k = 0; k < 200; ++k) {
      const Vector3 p = space.polar(0.015 * k, k);
      for (int i = 0; i < 3; ++i) {
        Vector3 q = p;
        q[i] = std::nextafter(q[i], 10.0);
        EXPECT_GE(space.distance(p, q), 0) << k;  // and is a number
        EXPECT_LT(space.distance(p, q), 1e-13);
      }
    }
  }
}

TEST(Spaces, HaveNamesCurvaturesAndShortestGeodesics) {
  EXPECT_EQ(Space::sphere().name(), "spherical");
  EXPECT_EQ(Space::plane().name(), "euclidean");
  EXPECT_EQ(Space::hyperbolic_plane().name(), "hyperbolic");
  EXPECT_EQ(Space(), Space::sphere());
  EXPECT_NE(Space::plane(), Space::sphere());
  EXPECT_EQ(Space::sphere().longest_unique(), pi);
  EXPECT_EQ(Space::plane().longest_unique(), std::numeric_limits<double>::infinity());
  EXPECT_EQ(Space::hyperbolic_plane().longest_unique(), std::numeric_limits<double>::infinity());
}

// ----------------------------------------------------------------------------------------- the sphere, known

std::vector<Vector3> all_over_the_sphere(int count, std::uint32_t seed) {
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
    area +=
        Space::sphere().area(mesh.V.row(mesh.F(f, 0)), mesh.V.row(mesh.F(f, 1)), mesh.V.row(mesh.F(f, 2)));
  return area;
}

TEST(Sphere, OctantsAreEighthsOfIt) {
  for (const double x : {1.0, -1.0})
    for (const double y : {1.0, -1.0})
      for (const double z : {1.0, -1.0})
        EXPECT_NEAR(Space::sphere().area({x, 0, 0}, {0, y, 0}, {0, 0, z}), x * y * z * pi / 2, 1e-15);
}

TEST(Sphere, ClosedMeshesHaveItsArea) {
  for (const Mesh& mesh : {test::icosphere(3), test::octasphere(2)})
    EXPECT_NEAR(total_area(mesh), 4 * pi, 1e-12);
}

TEST(Sphere, AreasOfTheTrianglesOfReflectionGroupsAreFractionsOfIt) {
  for (const auto& [n, order] : {std::pair(3, 24), std::pair(4, 48), std::pair(5, 120)}) {
    const hand_made::Triangle t(2, 3, n);
    EXPECT_NEAR(std::abs(Space::sphere().area(t.a, t.b, t.c)), 4 * pi / order, 1e-14);
  }
}

TEST(Sphere, IsometriesAreTheOrthogonalMatrices) {
  for (const Matrix3& M : {hand_made::rotation({1, 2, 3}, 0.7), hand_made::reflection({3, -1, 2})}) {
    EXPECT_LE(Space::sphere().isometry_defect(M), 1e-15);
    EXPECT_EQ(Space::sphere().isometry(M).inverse_matrix(), M.transpose());
  }
  const Vector3 axis = Vector3(1, 2, 3).normalized();
  EXPECT_LE((Space::sphere().rotation(axis, 0.7).matrix() - hand_made::rotation(axis, 0.7)).norm(), 1e-15);
  EXPECT_LE((Space::sphere().reflection({3, -1, 2}).matrix() - hand_made::reflection({3, -1, 2})).norm(),
            1e-15);
}

TEST(Sphere, AreasAndAnglesHoldAllOverIt) {
  const std::vector<Vector3> p = all_over_the_sphere(900, 4);
  for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
    Vector3 a = p[k], b = p[k + 1], c = p[k + 2];
    if (a.dot(b.cross(c)) < 0) std::swap(b, c);
    const double area = Space::sphere().area(a, b, c);
    EXPECT_NEAR(
        Space::sphere().angle(a, b, c) + Space::sphere().angle(b, c, a) + Space::sphere().angle(c, a, b) - pi,
        area, 1e-12);
    const Vector3 inside = (0.2 * a + 0.3 * b + 0.5 * c).normalized();
    EXPECT_NEAR(area,
                Space::sphere().area(a, b, inside) + Space::sphere().area(b, c, inside) +
                    Space::sphere().area(c, a, inside),
                1e-12);
  }
}

TEST(Sphere, SmallTrianglesHaveTheAreaOfFlatOnes) {
  const Vector3 p = Vector3(1, -2, 3).normalized();
  const Vector3 u = p.unitOrthogonal(), v = p.cross(u);
  for (const double size : {1e-3, 1e-5, 1e-7}) {
    const double area = Space::sphere().area((p + size * u).normalized(), (p + size * v).normalized(),
                                             (p - size * (u + v)).normalized());
    EXPECT_NEAR(area, 1.5 * size * size, 1e-5 * size * size + 1e-15 * size) << size;
  }
}

TEST(Sphere, DistanceIsAccurateNearZeroAndNearPi) {
  const Vector3 p = Vector3(1, 2, -1).normalized(), q = Vector3(0.3, -1, 2).normalized();
  const Space sphere;
  for (const double distance : {0.0, 1e-12, 1e-8, 1e-4, 1.0, pi / 2, 3.0})
    EXPECT_NEAR(sphere.distance(p, towards(p, q, distance)), distance, 4e-16) << distance;
  for (const double short_of : {0.0, 1e-12, 1e-8, 1e-4, 1.0})
    EXPECT_NEAR(pi - sphere.distance(p, -towards(p, q, short_of)), short_of, 1e-15) << short_of;
  EXPECT_EQ(sphere.distance(p, p), 0);
  EXPECT_LE(sphere.distance(p, -p), pi);
  for (const Vector3& r : all_over_the_sphere(200, 3))
    EXPECT_NEAR(sphere.distance(p, r) + sphere.distance(p, -r), pi, 1e-15);
}

}  // namespace
}  // namespace orbitutte::space_test
