// SPDX-License-Identifier: MIT
// The filter's bound follows J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", Discrete & Computational Geometry 18 (1997), for the 3 x 3 determinant.
#include "orbitutte/geometry/orientation.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>

namespace orbitutte {
namespace {

int exact_sign(const Vector3& a, const Vector3& b, const Vector3& c) {
  using Rational = boost::multiprecision::cpp_rational;
  const auto minor = [&](int i, int j) -> Rational {
    return Rational(b[i]) * Rational(c[j]) - Rational(b[j]) * Rational(c[i]);
  };
  const Rational determinant =
      Rational(a[0]) * minor(1, 2) + Rational(a[1]) * minor(2, 0) + Rational(a[2]) * minor(0, 1);
  return determinant.sign();
}

}  // namespace

int orientation_sign(const Vector3& a, const Vector3& b, const Vector3& c) {
  double determinant = 0, permanent = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double first = b[j] * c[k], second = b[k] * c[j];
    determinant += a[i] * (first - second);
    permanent += std::abs(a[i]) * (std::abs(first) + std::abs(second));
  }
  // (7 + 56 eps) eps bounds the relative error of rounding, the constant that of underflow.
  const double bound = 1e-15 * permanent + 1e-290;
  if (determinant > bound) return 1;
  if (determinant < -bound) return -1;
  return exact_sign(a, b, c);
}

}  // namespace orbitutte
