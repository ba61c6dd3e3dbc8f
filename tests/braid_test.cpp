// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/braid.h"

#include <gtest/gtest.h>

#include <cmath>
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
  const Points polygon = moduli.closed(moduli.doubled_polygon()).value();
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

TEST(Braid, PullsDerivativesBackAsDifferencesDo) {
  const Moduli moduli = hyperbolic(5);
  const Points cones = some_tile(moduli, 7);
  const Braid braid = {{1, true}, {2, false}, {0, false}};
  const Points weights = Points::Random(5, 3);
  const auto value = [&](const Points& at) { return braided(moduli, at, braid).cwiseProduct(weights).sum(); };
  const Points after = braided(moduli, cones, braid);
  Eigen::VectorXd derivative(10);
  constexpr double h = 1e-6;
  const auto moved = [&](const Points& from, const Eigen::VectorXd& step) {
    Points to;
    move_points(moduli.space(), from, moduli.tangents(from, step), 1, to);
    return to;
  };
  for (int q = 0; q < 10; ++q) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(10, q);
    derivative[q] = (moved(after, step) - moved(after, -step)).cwiseProduct(weights).sum() / (2 * h);
  }
  const Eigen::VectorXd pulled = pulled_back(moduli, cones, braid, derivative);
  for (int q = 0; q < 10; ++q) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(10, q);
    EXPECT_NEAR(pulled[q], (value(moved(cones, step)) - value(moved(cones, -step))) / (2 * h),
                1e-5 * pulled.norm());
  }
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
    undone += found.distance < 1e-5;
    EXPECT_GT(found.next_distance, found.distance) << seed;
  }
  EXPECT_GE(undone, 5);
}

}  // namespace
}  // namespace orbitutte::braid_test
