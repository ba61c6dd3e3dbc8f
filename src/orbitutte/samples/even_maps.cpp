// SPDX-License-Identifier: MIT
#include "orbitutte/samples/even_maps.h"

#include <array>
#include <cmath>
#include <complex>

namespace orbitutte {
namespace {

using Complex = std::complex<double>;

// The stereographic image, from the south pole, of p or -p, whichever lies above the equator: |z| <= 1.
Complex upper_stereographic(const Vector3& p) {
  const double sign = p[2] < 0 ? -1 : 1;
  return Complex(sign * p[0], sign * p[1]) / (1 + std::abs(p[2]));
}

// A pair of opposite limbs.
struct LimbPair {
  Vector3 axis;
  double height, sharpness;
};

const std::array<LimbPair, 3>& limb_pairs() {
  static const std::array<LimbPair, 3> result = {{{Vector3(2, 1, 3).normalized(), 0.6, 9},
                                                  {Vector3(-3, 2, 1).normalized(), 0.4, 12},
                                                  {Vector3(1, 3, -2).normalized(), 0.5, 7}}};
  return result;
}

// r(p) = 1 + sum_k h_k exp(-s_k (1 - <p, a_k>^2))
double limbed_radius(const Vector3& p) {
  double radius = 1;
  for (const auto& [axis, height, sharpness] : limb_pairs()) {
    const double cosine = p.dot(axis);
    radius += height * std::exp(-sharpness * (1 - cosine * cosine));
  }
  return radius;
}

}  // namespace

Vector3 boys_surface(const Vector3& p) {
  const Complex z = upper_stereographic(p), z2 = z * z, z3 = z2 * z, z4 = z2 * z2, z6 = z3 * z3;
  const Complex D = z6 + std::sqrt(5.0) * z3 - 1.0;
  const double size = std::abs(D);
  if (size == 0) return Vector3::Zero();  // g is infinite
  const Complex unit = std::conj(D) / size;
  const Vector3 scaled_g(-1.5 * (z * (1.0 - z4) * unit).imag(), -1.5 * (z * (1.0 + z4) * unit).real(),
                         ((1.0 + z6) * unit).imag() - 0.5 * size);  // |D| g
  return size * scaled_g / scaled_g.squaredNorm();
}

Vector3 roman_surface(const Vector3& p) { return {p[1] * p[2], p[2] * p[0], p[0] * p[1]}; }

Vector3 cross_cap(const Vector3& p) { return {p[1] * p[2], 2 * p[0] * p[1], p[0] * p[0] - p[1] * p[1]}; }

Vector3 limbed_quotient(const Vector3& p) { return limbed_radius(p) * boys_surface(p); }

}  // namespace orbitutte
