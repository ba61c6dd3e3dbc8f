// SPDX-License-Identifier: MIT
// The filter's bound follows J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust
// geometric predicates", Discrete & Computational Geometry 18 (1997), for the 3 x 3 determinant.
#include "orbitutte/geometry/orientation.h"

#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <cstdint>

namespace orbitutte {
namespace {

using WholeNumber = boost::multiprecision::cpp_int;

// In units of 2^-1127, of which every double is a multiple.
WholeNumber in_units(double x) {
  int exponent = 0;
  const double mantissa = std::frexp(x, &exponent);
  return WholeNumber(static_cast<std::int64_t>(std::ldexp(mantissa, 53))) << (exponent + 1074);
}

int exact_sign(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto minor = [&](int i, int j) -> WholeNumber {
    return in_units(b[i]) * in_units(c[j]) - in_units(b[j]) * in_units(c[i]);
  };
  const WholeNumber determinant =
      in_units(a[0]) * minor(1, 2) + in_units(a[1]) * minor(2, 0) + in_units(a[2]) * minor(0, 1);
  return determinant.sign();
}

// det[a b c], and a bound of its rounding errors.
struct RoundedDeterminant {
  double value = 0, error = 0;
};

RoundedDeterminant rounded_determinant(const Vector3& a, const Vector3& b, const Vector3& c) {
  double determinant = 0, permanent = 0;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const double first = b[j] * c[k], second = b[k] * c[j];
    determinant += a[i] * (first - second);
    permanent += std::abs(a[i]) * (std::abs(first) + std::abs(second));
  }
  // (7 + 56 eps) eps bounds the relative error of rounding, the constant that of underflow.
  return {determinant, 1e-15 * permanent + 1e-290};
}

// Of q - p, is every coordinate a double, which the rounded difference is?
bool is_exact(const Vector3& p, const Vector3& q, const Vector3& difference) {
  // What rounding leaves out (D. Knuth, "Seminumerical Algorithms", 4.2.2).
  const auto left_out = [&](int i) {
    const double from = q[i] - difference[i], to = difference[i] + from;
    return (q[i] - to) + (from - p[i]);
  };
  return left_out(0) == 0 && left_out(1) == 0 && left_out(2) == 0;
}

// The sign where rounding hides it. Vectors so close to each other as the corners of a small triangle have
// exact differences, almost always, and det[a b c] = det[a b-a c-a].
int hidden_sign(const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a;
  if (is_exact(a, b, ab) && is_exact(a, c, ac)) {
    const auto [determinant, error] = rounded_determinant(a, ab, ac);
    if (determinant > error) return 1;
    if (determinant < -error) return -1;
  }
  return exact_sign(a, b, c);
}

}  // namespace

int orientation_sign(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto [determinant, error] = rounded_determinant(a, b, c);
  if (determinant > error) return 1;
  if (determinant < -error) return -1;
  return hidden_sign(a, b, c);
}

bool is_visibly_positive(const Vector3& a, const Vector3& b, const Vector3& c) {
  const auto [determinant, error] = rounded_determinant(a, b, c);
  if (determinant > error) return true;
  if (determinant < -error) return false;
  const auto is_visible_at = [](const Vector3& p, const Vector3& q, const Vector3& r) {
    const auto [from_edges, error_of_edges] = rounded_determinant(p, q - p, r - p);
    return from_edges > error_of_edges;
  };
  return is_visible_at(a, b, c) && is_visible_at(b, c, a) && is_visible_at(c, a, b) &&
         hidden_sign(a, b, c) > 0;
}

}  // namespace orbitutte
