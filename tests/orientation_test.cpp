// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/orientation.h"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <Eigen/Geometry>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>

namespace orbitutte::orientation_test {
namespace {

// det[a b c] of the stored doubles by its six products, in rational arithmetic.
int exact_sign(const Vector3& a, const Vector3& b, const Vector3& c) {
  using Rational = boost::multiprecision::cpp_rational;
  Rational determinant = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    determinant += Rational(a[i]) * Rational(b[j]) * Rational(c[k]);
    determinant -= Rational(a[i]) * Rational(b[k]) * Rational(c[j]);
  }
  return determinant.sign();
}

void expect_exact(const Vector3& a, const Vector3& b, const Vector3& c) {
  const int sign = exact_sign(a, b, c);
  EXPECT_EQ(orientation_sign(a, b, c), sign)
      << a.transpose() << " / " << b.transpose() << " / " << c.transpose();
  EXPECT_EQ(orientation_sign(b, c, a), sign);
  EXPECT_EQ(orientation_sign(c, a, b), sign);
  EXPECT_EQ(orientation_sign(b, a, c), -sign);
  EXPECT_EQ(orientation_sign(a, c, b), -sign);
  EXPECT_EQ(orientation_sign(c, b, a), -sign);
}

class Vectors {
 public:
  explicit Vectors(std::uint32_t seed) : random_(seed) {}
  double number() { return std::uniform_real_distribution<double>(-1, 1)(random_); }
  Vector3 any() { return {number(), number(), number()}; }
  Vector3 unit() { return any().normalized(); }
  int below(int n) { return static_cast<int>(random_() % static_cast<unsigned>(n)); }

  // Every coordinate moved by up to two units in the last place.
  Vector3 nudged(Vector3 v) {
    for (double& x : v)
      for (int steps = below(5) - 2; steps != 0; steps += steps < 0 ? 1 : -1)
        x = std::nextafter(x, steps < 0 ? -4.0 : 4.0);
    return v;
  }

 private:
  std::mt19937 random_;
};

TEST(Orientation, AxesAreCounterclockwiseFromOutside) {
  expect_exact(Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ());
  EXPECT_EQ(orientation_sign(Vector3::UnitX(), Vector3::UnitY(), Vector3::UnitZ()), 1);
}

TEST(Orientation, SignIsThatOfTheRationalDeterminant) {
  Vectors vectors(1);
  for (int k = 0; k < 500; ++k) expect_exact(vectors.any(), vectors.any(), vectors.any());
}

TEST(Orientation, SignIsExactWhereThePlaneIsAlmostTouched) {
  Vectors vectors(2);
  int zeros = 0, positive = 0, negative = 0;
  for (int k = 0; k < 1000; ++k) {
    const Vector3 a = vectors.unit(), b = vectors.unit();
    const Vector3 c = vectors.nudged((vectors.number() * a + vectors.number() * b).eval());
    expect_exact(a, b, c);
    const int sign = exact_sign(a, b, c);
    (sign > 0 ? positive : sign < 0 ? negative : zeros)++;
  }
  EXPECT_GT(positive, 300);
  EXPECT_GT(negative, 300);
}

TEST(Orientation, SignIsExactWhereVectorsAlmostCoincide) {
  Vectors vectors(3);
  for (int k = 0; k < 1000; ++k) {
    const Vector3 a = vectors.unit();
    expect_exact(a, vectors.nudged(a), vectors.nudged(a));
    expect_exact(a, vectors.nudged(-a), vectors.unit());
  }
}

TEST(Orientation, SignIsExactWhereProductsUnderflow) {
  Vectors vectors(4);
  for (const double size : {1e-100, 1e-160, 1e-300, 1e-307}) {
    for (int k = 0; k < 50; ++k) {
      const Vector3 a = vectors.any(), b = vectors.any(), c = vectors.any();
      expect_exact(size * a, size * b, size * c);
      expect_exact(size * a, b, c);
      expect_exact(size * a, vectors.nudged(size * a), b);
      expect_exact(1e150 * a, size * b, 1e150 * c);
      expect_exact(size * a, size * b, (vectors.number() * size * a + vectors.number() * size * b).eval());
    }
  }
}

TEST(Orientation, SignIsExactOnDenormalNumbers) {
  const double least = std::numeric_limits<double>::denorm_min();
  Vectors vectors(5);
  for (int k = 0; k < 300; ++k) {
    const auto small = [&] {
      return Vector3(least * (vectors.below(7) - 3), least * (vectors.below(7) - 3),
                     least * (vectors.below(7) - 3));
    };
    expect_exact(small(), small(), small());
    expect_exact(small(), vectors.any(), vectors.any());
  }
  EXPECT_EQ(orientation_sign({least, 0, 0}, {0, least, 0}, {0, 0, least}), 1);
  EXPECT_EQ(orientation_sign({least, 0, 0}, {0, 0, least}, {0, least, 0}), -1);
}

TEST(Orientation, VectorsInOnePlaneWithTheOriginHaveSignZero) {
  Vectors vectors(6);
  for (int k = 0; k < 200; ++k) {
    const Vector3 a = vectors.unit(), b = vectors.unit();
    EXPECT_EQ(orientation_sign(a, b, a), 0);
    EXPECT_EQ(orientation_sign(a, b, -b), 0);
    EXPECT_EQ(orientation_sign(a, b, Vector3::Zero()), 0);
    EXPECT_EQ(orientation_sign(a, 0.5 * a, b), 0);
    EXPECT_EQ(orientation_sign({a.x(), a.y(), 0}, {b.x(), b.y(), 0}, {vectors.number(), vectors.number(), 0}),
              0);
    // Small whole numbers are added without rounding.
    const auto whole = [&] { return Vector3(vectors.below(999), vectors.below(999), vectors.below(999)); };
    const Vector3 p = whole(), q = whole();
    EXPECT_EQ(orientation_sign(p, q, 3 * p - 5 * q), 0);
  }
}

// The angle at p, as whoever reads stored positions measures it: from edges.
double determinant_from_edges(const Vector3& p, const Vector3& q, const Vector3& r) {
  return p.dot((q - p).cross(r - p));
}

TEST(Orientation, WhatIsVisiblyPositiveIsPositiveForWhoeverMeasuresIt) {
  Vectors vectors(7);
  int visible = 0, hidden = 0;
  for (int k = 0; k < 3000; ++k) {
    // Short edges along one great circle, and heights from far below to far above their rounding.
    const Vector3 a = vectors.unit(), along = vectors.unit().cross(a).normalized(), up = a.cross(along);
    const double length = std::pow(10.0, -vectors.below(9)),
                 height = length * std::pow(10.0, -vectors.below(30));
    const Vector3 b = (a + length * along).normalized(),
                  c = (a + length * vectors.number() * along + height * up).normalized();
    const int sign = exact_sign(a, b, c);
    const bool is_visible = is_visibly_positive(a, b, c);
    if (!is_visible) {
      hidden += sign > 0;
      continue;
    }
    ++visible;
    EXPECT_GT(sign, 0);
    EXPECT_FALSE(is_visibly_positive(a, c, b));
    for (int turn = 0; turn < 3; ++turn) {
      const std::array<Vector3, 3> at = {a, b, c};
      EXPECT_GT(determinant_from_edges(at[turn], at[(turn + 1) % 3], at[(turn + 2) % 3]), 0);
    }
  }
  EXPECT_GT(visible, 300);
  EXPECT_GT(hidden, 0);
}

TEST(Orientation, ScalingByPowersOfTwoChangesNoSign) {
  ASSERT_TRUE(rc::check([] {
    Vectors vectors(*rc::gen::arbitrary<std::uint32_t>());
    const Vector3 a = vectors.unit(), b = vectors.unit();
    const Vector3 c = vectors.nudged((a + b).normalized());
    const int exponent = *rc::gen::inRange(-300, 300);
    const Vector3 scaled = std::ldexp(1.0, exponent) * c;
    RC_ASSERT(orientation_sign(a, b, scaled) == orientation_sign(a, b, c));
    RC_ASSERT(orientation_sign(scaled, a, b) == exact_sign(a, b, c));
  }));
}

}  // namespace
}  // namespace orbitutte::orientation_test
