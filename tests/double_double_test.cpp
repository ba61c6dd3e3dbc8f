// SPDX-License-Identifier: MIT
// Numbers of two doubles, and the signs of determinants that they decide.
#include "orbitutte/geometry/double_double.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <random>

#include "orbitutte/map/placed_points.h"

namespace orbitutte::double_double_test {
namespace {

Precise exact(const DoubleDouble& x) { return Precise(x.high()) + Precise(x.low()); }

// Of all sizes from 2^-30 to 2^30, with both parts.
class Numbers {
 public:
  DoubleDouble draw() {
    const double high = std::ldexp(unit_(engine_), size_(engine_));
    return DoubleDouble::sum(high, high * std::ldexp(unit_(engine_), -53));
  }

 private:
  std::mt19937_64 engine_ = std::mt19937_64(7);
  std::uniform_real_distribution<double> unit_ = std::uniform_real_distribution<double>(-1, 1);
  std::uniform_int_distribution<int> size_ = std::uniform_int_distribution<int>(-30, 30);
};

void expect_near(const DoubleDouble& found, const Precise& expected, double units) {
  EXPECT_LE(static_cast<double>(Precise(abs(Precise(exact(found) - expected)))),
            units * DoubleDouble::unit * std::abs(static_cast<double>(expected)));
}

TEST(DoubleDouble, IsRightToTheErrorsThatItStates) {
  Numbers numbers;
  for (int trial = 0; trial < 20000; ++trial) {
    const DoubleDouble x = numbers.draw(), y = numbers.draw();
    expect_near(x + y, exact(x) + exact(y), 3);
    expect_near(x - y, exact(x) - exact(y), 3);
    expect_near(x * y, exact(x) * exact(y), 5);
    expect_near(x / y, exact(x) / exact(y), 16);
  }
}

TEST(DoubleDouble, KeepsItsDigitsWhereSumsCancel) {
  Numbers numbers;
  for (int trial = 0; trial < 2000; ++trial) {
    const DoubleDouble x = numbers.draw(), tiny = DoubleDouble(std::ldexp(1.0, -60)) * x;
    expect_near((x + tiny) - x, exact(x + tiny) - exact(x), 3);
    EXPECT_EQ(x - x, DoubleDouble(0));
  }
}

// Points around one place that differ by 1e-25 and less: doubles and further digits.
class NearPoints {
 public:
  explicit NearPoints(double distance) : sites_(Points::Zero(0, 3)) {
    std::mt19937_64 engine(11);
    std::uniform_real_distribution<double> unit(-1, 1);
    const Vector3 centre(unit(engine), unit(engine), 1);
    for (int k = 0; k < count; ++k) {
      const Vector3 away = distance * Vector3(unit(engine), unit(engine), unit(engine));
      positions_[k] = centre.cast<MostPrecise>() + away.cast<MostPrecise>();
      sites_.append(centre);
      sites_.set_exact(k, positions_[k]);
    }
  }

  static constexpr int count = 12;
  const Sites& sites() const { return sites_; }

  int sign(int p, int q, int r) const {
    const MostPrecise value = positions_[p].dot(positions_[q].cross(positions_[r]));
    return value > 0 ? 1 : value < 0 ? -1 : 0;
  }

 private:
  Sites sites_;
  std::array<Vector3Of<MostPrecise>, count> positions_;
};

TEST(ExactSigns, AreRightHoweverNearThePointsLie) {
  const ElementTable elements(Space::sphere());
  ExactSigns signs(elements);
  signs.use_all_digits();
  for (const double distance : {1e-3, 1e-12, 1e-17, 1e-25, 1e-33, 1e-70, 1e-120}) {
    const NearPoints points(distance);
    for (int k = 0; k + 2 < NearPoints::count; ++k) {
      const auto at = [&](int i) { return signs.placed(points.sites(), i); };
      EXPECT_EQ(signs.orientation(at(k), at(k + 1), at(k + 2)), points.sign(k, k + 1, k + 2)) << distance;
      EXPECT_EQ(signs.orientation(at(k + 1), at(k), at(k + 2)), -points.sign(k, k + 1, k + 2)) << distance;
      EXPECT_EQ(signs.orientation(at(k), at(k + 1), at(k)), 0) << distance;
    }
  }
}

// Two lines through a point of an edge, and others that cross it beside this by a share of `away`.
TEST(ExactSigns, OrderCrossingsThatShareAllDigitsOfDoubles) {
  const ElementTable elements(Space::sphere());
  const ExactSigns signs(elements);
  for (const double away : {1e-3, 1e-16, 1e-24, 1e-40}) {
    Sites sites(Points::Zero(0, 3));
    const Vector3 from(0.1, 0.2, 1), to(0.5, -0.3, 1), aside(0.3, 0.8, 0);
    const auto add = [&](const Vector3Of<MostPrecise>& position) {
      const int site = sites.append(position.cast<double>());
      sites.set_exact(site, position);
      return signs.placed(sites, site);
    };
    const auto on_edge = [&](double share, double rest) -> Vector3Of<MostPrecise> {
      const MostPrecise s = MostPrecise(share) + MostPrecise(rest);
      return (MostPrecise(1) - s) * from.cast<MostPrecise>() + s * to.cast<MostPrecise>();
    };
    const Vector3Of<MostPrecise> up = aside.cast<MostPrecise>(), first = on_edge(0.375, 0),
                                 second = on_edge(0.375, away);
    const PlacedPoint edge_from = add(from.cast<MostPrecise>()), edge_to = add(to.cast<MostPrecise>());
    const PlacedPoint a = add(first - up), b = add(first + up), c = add(second - up), d = add(second + up);
    const LineThrough edge = {edge_from, edge_to}, earlier = {a, b}, later = {c, d};
    EXPECT_EQ(signs.compare_shares(edge, earlier, later), -1) << away;
    EXPECT_EQ(signs.compare_shares(edge, later, earlier), 1) << away;
    EXPECT_EQ(signs.compare_shares(edge, earlier, earlier), 0) << away;
    EXPECT_NEAR(signs.share(edge, later).value, 0.375 + away, 1e-15);
  }
}

}  // namespace
}  // namespace orbitutte::double_double_test
