// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/moduli.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

namespace orbitutte::moduli_test {
namespace {

using std::numbers::pi;

Space space_of(int k) {
  return k > 0 ? Space::sphere() : k == 0 ? Space::plane() : Space::hyperbolic_plane();
}

// Angles of five marks, unequal, that the space has surfaces for.
std::vector<double> some_angles(int k) {
  if (k > 0) return {1.6 * pi, 1.5 * pi, 1.7 * pi, 1.55 * pi, 1.4 * pi};
  if (k == 0) return {1.1 * pi, 1.3 * pi, 1.2 * pi, 0.9 * pi, 1.5 * pi};
  return {pi, 0.9 * pi, 1.1 * pi, pi / 2, 2 * pi / 3};
}

// A sphere with these cones, or a disk with four corners, one of them concave but on the sphere, and two
// cones.
enum class Kind { sphere, disk };

std::vector<Mark> some_marks(int k, Kind kind) {
  std::vector<Mark> marks;
  if (kind == Kind::sphere) {
    for (const double angle : some_angles(k)) marks.push_back({angle, ConeKind::rotation});
    return marks;
  }
  const auto add = [&](double angle, ConeKind of_mark) { marks.push_back({angle * pi, of_mark}); };
  add(k > 0 ? 0.98 : k == 0 ? 0.6 : 0.4, ConeKind::corner);
  add(k > 0 ? 1.1 : k == 0 ? 1.3 : 0.8, ConeKind::rotation);
  add(k > 0 ? 0.95 : k == 0 ? 1.2 : 1.3, ConeKind::corner);
  add(k > 0 ? 0.97 : k == 0 ? 0.7 : 0.5, ConeKind::corner);
  add(k > 0 ? 0.96 : k == 0 ? 0.8 : 0.3, ConeKind::corner);
  add(k > 0 ? 1.3 : k == 0 ? 1.4 : 1.1, ConeKind::rotation);
  return marks;
}

struct ModuliCase {
  int k;
  Kind kind;
};

class EveryModuli : public testing::TestWithParam<ModuliCase> {
 protected:
  int k() const { return GetParam().k; }
  bool is_disk() const { return GetParam().kind == Kind::disk; }
  Space space() const { return space_of(k()); }
  Moduli moduli() const { return Moduli(space(), some_marks(k(), GetParam().kind)); }

  // Marks of a closed surface that has no symmetry.
  Points closed_marks(std::uint32_t seed = 1) const {
    const Moduli all = moduli();
    Points marks = all.inscribed_polygon();
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-0.1, 0.1);
    Eigen::VectorXd step(2 * all.mark_count());
    for (double& entry : step) entry = uniform(random);
    const Eigen::MatrixXd basis = all.basis(marks);
    return all.retract(marks, basis * (basis.transpose() * step)).value();
  }

  // Marks moved along geodesics, whether the surface closes or not.
  Points moved(const Points& marks, const Eigen::VectorXd& step) const {
    const Points direction = moduli().tangents(marks, step);
    Points result = marks;
    for (Eigen::Index i = 0; i < marks.rows(); ++i) {
      const Vector3 u = direction.row(i);
      const double length = space().norm(u);
      if (length > 0) result.row(i) = space().at(marks.row(i), u / length, length);
    }
    return result;
  }

  Eigen::MatrixXd all_directions() const {
    return Eigen::MatrixXd::Identity(2 * moduli().mark_count(), 2 * moduli().mark_count());
  }
};

INSTANTIATE_TEST_SUITE_P(Geometry, EveryModuli,
                         testing::Values(ModuliCase{1, Kind::sphere}, ModuliCase{0, Kind::sphere},
                                         ModuliCase{-1, Kind::sphere}, ModuliCase{1, Kind::disk},
                                         ModuliCase{0, Kind::disk}, ModuliCase{-1, Kind::disk}),
                         [](const auto& info) {
                           const int k = info.param.k;
                           const std::string space = k > 0 ? "sphere" : k == 0 ? "plane" : "hyperboloid";
                           return (info.param.kind == Kind::disk ? "disk_" : "closed_") + space;
                         });

Isometry whole_product(const std::vector<Isometry>& rotations) {
  Isometry result;
  for (const Isometry& rotation : rotations) result = result * rotation;
  return result;
}

// The word R_3 R_1^-1 R_2 R_2.
template <typename Element>
Element some_word(const std::vector<Element>& R) {
  return R[2] * R[0].inverse() * R[1] * R[1];
}

TEST_P(EveryModuli, RatesOfWordsAreTheirDerivatives) {
  const Moduli all = moduli();
  const Points marks = closed_marks();
  const VaryingIsometry word = some_word(all.varying(marks).generators());
  constexpr double h = 1e-5;
  for (Eigen::Index q = 0; q < word.motion.parameters(); ++q) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(word.motion.parameters(), q);
    const Matrix3 difference = some_word(all.generators(moved(marks, step))).matrix() -
                               some_word(all.generators(moved(marks, -step))).matrix();
    const Matrix3 rate = infinitesimal_isometry(space(), word.motion.first.col(q)) * word.value.matrix();
    EXPECT_LT((difference / (2 * h) - rate).cwiseAbs().maxCoeff(), 1e-8 * (10 + rate.norm())) << q;
  }
}

// Of exp(u(t)) g: g'' = (u_ab + (u_a u_b + u_b u_a)/2) g.
TEST_P(EveryModuli, SecondDerivativesOfWordsAreThoseOfTheirRates) {
  const Moduli all = moduli();
  const Points marks = closed_marks();
  const VaryingMotion motion =
      some_word(all.varying(marks, all_directions(), Order::second).generators()).motion;
  const auto derivative = [&](const Points& at, Eigen::Index q) -> Matrix3 {
    const VaryingIsometry word = some_word(all.varying(at).generators());
    return infinitesimal_isometry(space(), word.motion.first.col(q)) * word.value.matrix();
  };
  const Isometry word = some_word(all.generators(marks));
  constexpr double h = 1e-5;
  const Eigen::Index count = motion.parameters();
  for (Eigen::Index a = 0; a < count; ++a) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(count, a);
    // Frames at marks that have moved are turned about them: only the moving mark's own count.
    for (const Eigen::Index b : {a, (a + 2) % count}) {
      const Matrix3 A = infinitesimal_isometry(space(), motion.first.col(a)),
                    B = infinitesimal_isometry(space(), motion.first.col(b)),
                    second = infinitesimal_isometry(space(), motion.second.col(count * a + b)) +
                             0.5 * (A * B + B * A);
      const Matrix3 difference =
          b == a
              ? Matrix3((some_word(all.generators(moved(marks, step * 10))).matrix() - 2 * word.matrix() +
                         some_word(all.generators(moved(marks, -step * 10))).matrix()) /
                        (100 * h * h))
              : Matrix3((derivative(moved(marks, step), b) - derivative(moved(marks, -step), b)) / (2 * h));
      const double size = 1 + (second * word.matrix()).cwiseAbs().maxCoeff();
      EXPECT_LT((difference - second * word.matrix()).cwiseAbs().maxCoeff(), 1e-5 * size) << a << " " << b;
    }
  }
}

TEST_P(EveryModuli, TheClosingsSecondDerivativeIsThatOfDifferences) {
  const Moduli all = moduli();
  const Points marks = closed_marks();
  const Eigen::VectorXd multipliers = Eigen::VectorXd::LinSpaced(all.closing(marks).size(), 0.5, 2);
  const Eigen::MatrixXd second =
      all.varying(marks, all_directions(), Order::second).closing_curvature(multipliers);
  constexpr double h = 1e-4;
  const auto at = [&](const Eigen::VectorXd& step) {
    return multipliers.dot(all.closing(moved(marks, step)));
  };
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    Eigen::VectorXd step(second.cols());
    for (double& entry : step) entry = normal(random);
    const double difference = (at(h * step) - 2 * at(0 * step) + at(-h * step)) / (h * h);
    EXPECT_NEAR(step.dot(second * step), difference, 3e-5 * (1 + second.cwiseAbs().sum())) << seed;
  }
}

TEST_P(EveryModuli, TheClosingsJacobianIsItsDerivativeAlsoWhereItIsOpen) {
  const Moduli all = moduli();
  Points marks = closed_marks();
  marks = moved(marks, Eigen::VectorXd::LinSpaced(2 * all.mark_count(), -0.1, 0.2));
  const Eigen::MatrixXd jacobian = all.closing_jacobian(marks);
  constexpr double h = 1e-5;
  EXPECT_GT(all.closing(marks).norm(), 1e-3);
  for (Eigen::Index q = 0; q < jacobian.cols(); ++q) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(jacobian.cols(), q);
    const Eigen::VectorXd rate =
        (all.closing(moved(marks, step)) - all.closing(moved(marks, -step))) / (2 * h);
    EXPECT_LT((rate - jacobian.col(q)).cwiseAbs().maxCoeff(), 1e-7) << q;
  }
}

TEST_P(EveryModuli, TheBasisKeepsTheSurfaceClosedAndMakesNoIsometry) {
  const Moduli all = moduli();
  const Points marks = closed_marks();
  const Eigen::MatrixXd basis = all.basis(marks);
  ASSERT_EQ(basis.cols(), all.dimension());
  EXPECT_TRUE((basis.transpose() * basis).isIdentity(1e-12));
  EXPECT_LT((all.closing_jacobian(marks) * basis).cwiseAbs().maxCoeff(), 1e-11);
  for (int a = 0; a < 3; ++a) {
    const Matrix3 motion = infinitesimal_isometry(space(), Vector3::Unit(a));
    const Eigen::VectorXd step = all.coordinates(marks, marks * motion.transpose());
    EXPECT_GT(step.norm(), 0.1);
    EXPECT_LT((basis.transpose() * step).norm(), 1e-11);
  }
}

TEST_P(EveryModuli, StepsAlongTheBasisNeedNoCorrectionAtFirstOrder) {
  const Moduli all = moduli();
  const Points marks = closed_marks();
  const Eigen::MatrixXd basis = all.basis(marks);
  for (const double h : {1e-2, 1e-3}) {
    const Eigen::VectorXd step = h * basis.col(basis.cols() - 1);
    const Points there = all.retract(marks, step).value();
    EXPECT_LT((there - moved(marks, step)).norm(), 30 * h * h);
    EXPECT_LT(all.closing(there).norm(), 1e-12);
  }
}

TEST_P(EveryModuli, ClosedMarksMultiplyToTheIdentityAndEncloseTheirArea) {
  if (is_disk()) return;
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const Points marks = closed_marks(seed);
    EXPECT_LT(whole_product(moduli().generators(marks)).difference(Isometry()), 1e-11);
    EXPECT_TRUE(moduli().encloses_area(marks));
    for (Eigen::Index i = 0; i < marks.rows(); ++i) EXPECT_LT(space().defect(marks.row(i)), 1e-13);
  }
}

// Where mirrors meet, the product of both reflections is the rotation by twice the angle between them.
TEST_P(EveryModuli, MirrorsMeetInTheAnglesOfCorners) {
  if (!is_disk()) return;
  const Moduli all = moduli();
  for (const std::uint32_t seed : {1u, 2u, 3u}) {
    const Points marks = closed_marks(seed);
    EXPECT_TRUE(all.encloses_area(marks));
    const std::vector<Isometry> g = all.generators(marks);
    EXPECT_TRUE(g[3].reverses_orientation());
    EXPECT_LT((g[3] * g[4]).difference(space().rotation(marks.row(4), 2 * all.marks()[4].angle)), 1e-9);
    const Isometry behind = g[5];  // a cone between the last corner and the first
    const Isometry last = behind.inverse() * g[4] * behind;
    EXPECT_LT((last * g[0]).difference(space().rotation(marks.row(0), 2 * all.marks()[0].angle)), 1e-9);
    for (Eigen::Index i = 0; i < marks.rows(); ++i) EXPECT_LT(space().defect(marks.row(i)), 1e-13);
  }
}

// A disk whose marks are all corners is half of a sphere.
TEST(Moduli, ARightAngledPentagonIsTheDiskOfItsOwnDouble) {
  const Moduli disk(Space::hyperbolic_plane(), std::vector<Mark>(5, {pi / 2, ConeKind::corner})),
      sphere(Space::hyperbolic_plane(), std::vector<double>(5, pi));
  EXPECT_EQ(disk.dimension(), 2);
  EXPECT_NEAR(2 * disk.area(), sphere.area(), 1e-12);
  EXPECT_LT((disk.inscribed_polygon() - sphere.inscribed_polygon()).norm(), 1e-12);
  EXPECT_LT(disk.closing(disk.inscribed_polygon()).norm(), 1e-12);
}

// The doubled polygon is its own mirror image: the later copies of marks are reflections of the first ones.
TEST_P(EveryModuli, TheDoubledPolygonClosesWithHalfTheAngles) {
  if (is_disk()) return;
  const std::vector<double> angles = some_angles(k());
  const Points marks = moduli().inscribed_polygon();
  EXPECT_LT(whole_product(moduli().generators(marks)).difference(Isometry()), 1e-12);
  const int count = static_cast<int>(angles.size());
  for (int i = 0; i < count; ++i)
    EXPECT_NEAR(space().angle(marks.row(i), marks.row((i + 1) % count), marks.row((i + count - 1) % count)),
                angles[i] / 2, 1e-12)
        << "at mark " << i;
}

TEST_P(EveryModuli, MarksFarOffAreNotClosedByAnotherSurface) {
  const Moduli all = moduli();
  const Points marks = all.inscribed_polygon();
  for (const double size : {0.5, 1.0, 2.0, 4.0})
    for (int q = 0; q < all.dimension(); ++q) {
      const std::optional<Points> there = all.retract(marks, size * all.basis(marks).col(q));
      if (!there) continue;
      EXPECT_TRUE(all.encloses_area(*there));
      EXPECT_LT(all.closing(*there).norm(), 1e-9);
    }
}

// --------------------------------------------------------------------------------------------- known cases

double side(const Moduli& moduli, int i) {
  const Points marks = moduli.inscribed_polygon();
  return moduli.space().distance(marks.row(i), marks.row((i + 1) % moduli.mark_count()));
}

TEST(Moduli, TheDoubledRightAngledPentagonIsHyperbolic22222) {
  const Moduli moduli(Space::hyperbolic_plane(), std::vector<double>(5, pi));
  EXPECT_NEAR(moduli.area(), pi, 1e-12);
  for (int i = 0; i < 5; ++i) EXPECT_NEAR(std::cosh(side(moduli, i)), std::numbers::phi, 1e-12);
}

TEST(Moduli, RegularPolygonsHaveTheSidesOfTrigonometry) {
  for (const int n : {3, 4, 6, 8}) {
    // cs(side/2) = cos(pi/n)/sin(angle/2) of the polygon's angle
    const double flat = pi * (n - 2) / n;
    const double wide = flat + 0.1, narrow = flat - 0.2;
    const auto expected = [&](double angle) { return std::cos(pi / n) / std::sin(angle / 2); };
    EXPECT_NEAR(std::cos(side(Moduli(Space::sphere(), std::vector<double>(n, 2 * wide)), 0) / 2),
                expected(wide), 1e-12);
    EXPECT_NEAR(std::cosh(side(Moduli(Space::hyperbolic_plane(), std::vector<double>(n, 2 * narrow)), 0) / 2),
                expected(narrow), 1e-12);
  }
}

TEST(Moduli, ThreeHalfTurnsLieAtRightAnglesAndHaveNoFreedom) {
  const Moduli moduli(Space::sphere(), std::vector<double>(3, pi));
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(side(moduli, i), pi / 2, 1e-12);
  EXPECT_EQ(moduli.dimension(), 0);
  EXPECT_EQ(moduli.basis(moduli.inscribed_polygon()).cols(), 0);
}

// Copies of the first cone may be opposite to it: where a cone of pi lies at a right angle from it.
TEST(Moduli, ThreeConesEncloseTheirAreaInAnyOrder) {
  for (std::vector<double> angles : {std::vector<double>{pi, pi, pi},
                                     {0.5 * pi, pi, pi},
                                     {pi, pi, 1.7 * pi},
                                     {0.5 * pi, 2 * pi / 3, pi},
                                     {1.5 * pi, 1.5 * pi, 1.5 * pi}}) {
    do {
      const Moduli moduli(Space::sphere(), angles);
      const Points marks = moduli.inscribed_polygon();
      EXPECT_TRUE(moduli.encloses_area(marks)) << angles[0] << " " << angles[1] << " " << angles[2];
      EXPECT_TRUE(moduli.closed(marks)) << angles[0] << " " << angles[1] << " " << angles[2];
    } while (std::next_permutation(angles.begin(), angles.end()));
  }
}

// A corner whose quarter angle is least may lie more than a quarter of a circle around from the others.
TEST(Moduli, ATriangleWithOneSmallAngleIsASphericalTriangle) {
  const std::vector<double> angles = {0.5 * pi, 1.2 * pi, 1.1 * pi};
  const Moduli moduli(Space::sphere(), angles);
  const double a = angles[0] / 2, b = angles[1] / 2, c = angles[2] / 2;
  EXPECT_NEAR(side(moduli, 1), Space::sphere().side_opposite(a, b, c), 1e-12);
  EXPECT_NEAR(side(moduli, 2), Space::sphere().side_opposite(b, c, a), 1e-12);
}

// As the curvature of the surface goes to zero from either side, its shape goes to the flat one.
TEST(Moduli, CurvedSurfacesOfLittleAreaMeetTheFlatOne) {
  const std::vector<double> flat = some_angles(0);
  const Moduli plane(Space::plane(), flat);
  for (const int k : {1, -1}) {
    double last = 1;
    for (const double area : {1e-2, 1e-4, 1e-6}) {
      std::vector<double> angles = flat;
      for (double& angle : angles) angle += k * area / static_cast<double>(angles.size());
      const Moduli curved(space_of(k), angles);
      double off = 0;
      for (int i = 0; i < plane.mark_count(); ++i)
        off = std::max(off, std::abs(side(curved, i) / side(curved, 0) - side(plane, i) / side(plane, 0)));
      EXPECT_LT(off, 2 * area);
      EXPECT_LT(off, last);
      last = off;
      const Points marks = curved.inscribed_polygon();
      Eigen::VectorXd step = Eigen::VectorXd::LinSpaced(curved.dimension(), 0.3, 1);
      step *= 0.1 * side(curved, 0);
      EXPECT_TRUE(curved.retract(marks, curved.basis(marks) * step)) << "area " << area;
    }
  }
}

// Five tips of a pentagram close, too, but their surface winds around twice.
TEST(Moduli, APentagramIsNoSurfaceOfTheseAngles) {
  const double angle = pi / 3;
  const Moduli moduli(Space::hyperbolic_plane(), std::vector<double>(5, angle));
  const double to_tip = std::acosh(1 / (std::tan(2 * pi / 5) * std::tan(angle / 4)));
  Points tips(5, 3);
  for (int i = 0; i < 5; ++i) tips.row(i) = moduli.space().polar(to_tip, i * 4 * pi / 5);
  EXPECT_LT(whole_product(moduli.generators(tips)).difference(Isometry()), 1e-10);
  EXPECT_FALSE(moduli.encloses_area(tips));
  EXPECT_FALSE(moduli.closed(tips));
}

TEST(Moduli, RefusesAnglesOfNoSurface) {
  const Space sphere = Space::sphere(), hyperbolic = Space::hyperbolic_plane();
  EXPECT_THROW(Moduli(sphere, {pi, pi}), ArgumentError);
  EXPECT_THROW(Moduli(sphere, {pi, pi, 2.1 * pi}), ArgumentError);
  EXPECT_THROW(Moduli(sphere, {pi, pi, 0}), ArgumentError);
  EXPECT_THROW(Moduli(sphere, {pi, pi, pi, pi}), ArgumentError) << "flat";
  EXPECT_THROW(Moduli(hyperbolic, {pi, pi, pi, pi}), ArgumentError);
  EXPECT_THROW(Moduli(hyperbolic, {pi, pi, pi}), ArgumentError) << "spherical";
  EXPECT_THROW(Moduli(sphere, {0.5 * pi, 1.9 * pi, 1.7 * pi}), ArgumentError) << "Troyanov's bound";
  EXPECT_NO_THROW(Moduli(sphere, {0.5 * pi, 1.4 * pi, 1.05 * pi}));
  const auto polygon = [](std::vector<double> angles) {
    std::vector<Mark> marks;
    for (const double angle : angles) marks.push_back({angle * pi, ConeKind::corner});
    return marks;
  };
  EXPECT_THROW(Moduli(sphere, polygon({0.5, 0.5})), ArgumentError);
  EXPECT_THROW(Moduli(sphere, polygon({0.5, 0.5, 1.2})), ArgumentError) << "concave";
  EXPECT_THROW(Moduli(hyperbolic, polygon({0.5, 0.5, 0.5})), ArgumentError) << "spherical";
  EXPECT_NO_THROW(Moduli(sphere, polygon({0.5, 0.5, 0.5})));
  EXPECT_NO_THROW(Moduli(hyperbolic, polygon({0.3, 0.2, 0.2, 1.2})));
}

}  // namespace
}  // namespace orbitutte::moduli_test
