// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/braid.h"

#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numbers>
#include <optional>
#include <random>

#include "orbitutte/map/isotopy_class.h"

namespace orbitutte::braid_test {
namespace {

using std::numbers::pi;

// A closed tile of so many cones of order two that is not regular.
Points some_tile(const Moduli& moduli, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-0.15, 0.15);
  const Points polygon = moduli.closed(moduli.inscribed_polygon()).value();
  Eigen::VectorXd step(moduli.dimension());
  for (double& s : step) s = uniform(random);
  return moduli.retract(polygon, moduli.basis(polygon) * step).value();
}

Moduli hyperbolic(int k) { return {Space::hyperbolic_plane(), std::vector<double>(k, pi)}; }

Braid random_braid(int k, int length, unsigned seed) {
  std::mt19937 random(seed);
  Braid braid;
  for (int n = 0; n < length; ++n)
    braid = product(braid, {{static_cast<int>(random() % (k - 1)), random() % 2 == 0}});
  return braid;
}

// Words of full twists, which leave every cone in its place.
Braid random_pure_braid(int k, int letters, unsigned seed) {
  std::mt19937 random(seed);
  Braid braid;
  for (int n = 0; n < letters; ++n) {
    const int i = static_cast<int>(random() % (k - 1));
    const int j = i + 1 + static_cast<int>(random() % (k - 1 - i));
    braid = product(braid, full_twist(i, j, random() % 2 == 0));
  }
  return braid;
}

// The tile cut another way, as a map onto it would have it: around (0, 0, 1), and closed. Twists that
// rounding spoils are left out.
Points cut_another_way(const Moduli& moduli, Points cones, int letters, unsigned seed) {
  const Space space = moduli.space();
  for (int n = 0; n < letters; ++n) {
    const Points after = braided(moduli, cones, random_pure_braid(moduli.mark_count(), 1, seed + 100 * n));
    const Vector3 mean = space.retract(after.colwise().mean().transpose());
    Points there = space.to_origin(mean).on_rows(after);
    retract_points(space, there);
    if (const std::optional<Points> closed = moduli.closed(there)) cones = *closed;
  }
  return cones;
}

TEST(Braid, KeepsTheSurfaceClosed) {
  const Moduli moduli = hyperbolic(6);
  const Points cones = some_tile(moduli, 1), after = braided(moduli, cones, random_braid(6, 3, 2));
  EXPECT_GT((after - cones).norm(), 0.1);
  EXPECT_LT(moduli.closing(after).norm(), 1e-12 * std::pow(after.cwiseAbs().maxCoeff(), 3));
}

TEST(Braid, IsTakenBackByItsInverse) {
  const Moduli moduli = hyperbolic(5);
  const Points cones = some_tile(moduli, 3);
  const Braid braid = random_braid(5, 6, 4);
  EXPECT_LT((braided(moduli, braided(moduli, cones, braid), inverse(braid)) - cones).norm(), 1e-7);
  EXPECT_TRUE(product(braid, inverse(braid)).empty());
}

TEST(Braid, MotionsSayWhereEveryConeWent) {
  const Moduli moduli = hyperbolic(5);
  const Points cones = some_tile(moduli, 5);
  const Braid braid = full_twist(1, 3, true);
  const Points after = braided(moduli, cones, braid);
  const std::vector<Isometry> motion = motions(moduli, cones, braid);
  for (int i = 0; i < 5; ++i)
    EXPECT_LT((motion[i] * Vector3(cones.row(i)) - Vector3(after.row(i))).norm(), 1e-6 * after.row(i).norm())
        << i;
}

TEST(Braid, MovesConesAsDifferencesDo) {
  const Moduli moduli = hyperbolic(5);
  const Points cones = some_tile(moduli, 7);
  const Braid braid = {{1, true}, {2, false}, {0, false}};
  const Eigen::MatrixXd direction = Eigen::VectorXd::LinSpaced(10, -1, 0.8);
  constexpr double h = 1e-4;
  const auto at = [&](double t) {
    Points to;
    move_points(moduli.space(), cones, moduli.tangents(cones, t * direction), 1, to);
    return braided(moduli, to, braid);
  };
  const Points here = at(0), forth = at(h), back = at(-h);
  const VaryingMarks moving = braided(moduli.varying(cones, direction, Order::second), braid);
  for (int k = 0; k < 5; ++k) {
    const VaryingPoint& point = moving.points()[k];
    const Vector3 velocity = point.motion.velocities(point.position),
                  acceleration = point.motion.accelerations(point.position),
                  first = (forth - back).row(k) / (2 * h),
                  second = (forth - 2 * here + back).row(k) / (h * h);
    EXPECT_LT((point.position - Vector3(here.row(k))).norm(), 1e-12 * here.row(k).norm()) << k;
    EXPECT_LT((velocity - first).norm(), 1e-6 * first.norm()) << k;
    EXPECT_LT((acceleration - second).norm(), 1e-4 * (second.norm() + first.norm())) << k;
    const Isometry rotation = moduli.space().rotation(point.position, moduli.marks()[k].angle);
    EXPECT_LT((moving.rotations()[k].value.matrix() - rotation.matrix()).norm(),
              1e-9 * rotation.matrix().norm());
  }
}

// In the plane braids are linear.
TEST(Braid, OfEqualConesInThePlaneIsAMatrix) {
  constexpr double angle = 2 * pi - 4 * pi / 6;
  const Moduli moduli(Space::plane(), std::vector<double>(6, angle));
  Points cones = Points::Ones(6, 3);
  cones.leftCols(2).setRandom();
  const Braid braid = random_pure_braid(6, 5, 3);
  const Points moved = braided(moduli, cones, braid);
  const Eigen::VectorXcd z = cones.col(0) + std::complex<double>(0, 1) * cones.col(1),
                         image = braid_matrix(6, braid, angle) * z;
  for (int k = 0; k < 6; ++k)
    EXPECT_LT(std::abs(image[k] - std::complex<double>(moved(k, 0), moved(k, 1))), 1e-9) << k;
}

TEST(IsotopyClass, OfFourConesUndoesAnyPureBraid) {
  Eigen::VectorXcd a(4), b(4);
  a << std::complex<double>(0, 0), std::complex<double>(1, 0.1), std::complex<double>(1.2, 1.1),
      std::complex<double>(0.2, 1);
  b << std::complex<double>(0, 0), std::complex<double>(1, -0.1), std::complex<double>(0.9, 1.2),
      std::complex<double>(-0.1, 1.3);
  const double apart = isotopy_class_of_four(a, b).distance;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Braid braid = random_pure_braid(4, 1 + static_cast<int>(seed % 6), seed);
    const Eigen::VectorXcd twisted = braid_matrix(4, braid) * b;
    const IsotopyClass found = isotopy_class_of_four(a, twisted);
    EXPECT_NEAR(found.distance, apart, 1e-7) << seed;
    EXPECT_GT(found.next_distance, 2 * apart) << seed;
    const Eigen::VectorXcd back = braid_matrix(4, found.braid) * twisted;
    const auto shape = [](const Eigen::VectorXcd& p) { return (p[2] - p[1]) / (p[1] - p[0]); };
    EXPECT_LT(std::abs(shape(back) - shape(b)), 1e-7) << seed;
  }
}

class IsotopyClassOfMany : public testing::TestWithParam<int> {};
INSTANTIATE_TEST_SUITE_P(Cones, IsotopyClassOfMany, testing::Values(5, 6, 8));

TEST_P(IsotopyClassOfMany, UndoesPureBraids) {
  const int k = GetParam();
  const Moduli moduli = hyperbolic(k);
  const Points a = some_tile(moduli, 11);
  int undone = 0;
  for (unsigned seed = 0; seed < 6; ++seed) {
    const Points b = cut_another_way(moduli, a, 1 + static_cast<int>(seed % 3), seed);
    const IsotopyClass found = isotopy_class(moduli, a, b);
    if (found.distance > 1e-5) continue;  // then a class may be nearer that is not near enough to be taken
    ++undone;
    EXPECT_GT(found.next_distance, found.distance) << seed;
  }
  EXPECT_GE(undone, 5);
}

}  // namespace
}  // namespace orbitutte::braid_test
