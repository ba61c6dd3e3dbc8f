// SPDX-License-Identifier: MIT
// The distance of two points from their difference, by one power series for all three geometries.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

#include "orbitutte/types.h"

namespace orbitutte {

/// The formulas that are evaluated once for every edge, with the curvature k = 1, 0 or -1 known to the
/// compiler. Points p satisfy k (x^2 + y^2) + z^2 = 1; sn(d) is sin d, d or sinh d.
template <int k>
struct Curvature {
  /// <u, v> = u_x v_x + u_y v_y + k u_z v_z: the metric on tangent vectors.
  static double dot(const Vector3& u, const Vector3& v) {
    if constexpr (k == 1) return u.dot(v);
    if constexpr (k == 0) return u.head<2>().dot(v.head<2>());
    return u.head<2>().dot(v.head<2>()) - u.z() * v.z();
  }

  /// n(p) . v with the gradient n = (k x, k y, z) of the equation of the space: zero for tangent vectors v at
  /// p, one for p itself.
  static double off_tangent(const Vector3& p, const Vector3& v) {
    if constexpr (k == 1) return p.dot(v);
    if constexpr (k == 0) return p.z() * v.z();
    return p.z() * v.z() - p.head<2>().dot(v.head<2>());
  }

  /// The part of v in the tangent plane at p: v - (n(p) . v) p.
  static Vector3 tangent(const Vector3& p, const Vector3& v) { return v - off_tangent(p, v) * p; }

  /// The point of the space on the line from the origin of R^3 through p.
  static Vector3 retract(const Vector3& p) {
    if constexpr (k == 1) return p.normalized();
    if constexpr (k == 0) return p / p.z();
    return p / std::sqrt(p.z() * p.z() - p.head<2>().squaredNorm());
  }

  /// d^2 and d/sn d of the distance d.
  struct Distance {
    double squared, over_sn;
  };

  /// From the squared chord <p - q, p - q> = 4 sn^2(d/2), without the loss of digits between neighbours that
  /// the paper's atan2(|p x q|, <p, q>) has. At d = pi on the sphere d/sin d has a pole, since the shortest
  /// arc is not unique there: the slope is then the one just before it, large and finite, so that a line
  /// search turns back.
  static Distance distance(const Vector3& p, const Vector3& q) {
    const Vector3 difference = p - q;
    const double squared_chord = dot(difference, difference), s = squared_chord / 4;
    if constexpr (k == 0) {
      return {squared_chord, 1};
    } else {
      if (s < 0x1p-13) return from_series<4>(s);
      if (s < 0x1p-6) return from_series<terms>(s);
      if constexpr (k == 1) {
        const double d = 2 * std::atan2(std::sqrt(squared_chord), (p + q).norm());
        return {d * d, d / std::max(std::sin(d), 1e-8)};
      } else {
        const double d = 2 * std::asinh(std::sqrt(s));
        return {d * d, d / std::sinh(d)};
      }
    }
  }

  /// d(d/sn d)/ds, with s = 4 sn^2(d/2) the squared chord: (1 - cs d d/sn d)/(2 sn^2 d). Nearby by the series
  /// of d/sn d, the sum of G_j (k s/4)^j.
  static double slope_of_over_sn(double squared_chord, double over_sn) {
    constexpr double nearby = 0.01;
    const double s = squared_chord;
    if (s > nearby) return (1 - (1 - k * s / 2) * over_sn) / (2 * s * (1 - k * s / 4));
    double sum = 0, power = k / 4.0, G = 2.0 / 3;
    for (int j = 1; j <= 6; ++j) {
      sum += j * G * power;
      power *= k * s / 4;
      G *= 2.0 * (j + 1) / (2 * j + 3);
    }
    return sum;
  }

  /// d/sn d of two neighbours, from their squared chord alone.
  static double over_sn(double squared_chord) {
    const double s = squared_chord / 4;
    if constexpr (k == 0) return 1;
    if (s < 0x1p-6) return from_series<terms>(s).over_sn;
    const double d = k == 1 ? 2 * std::asin(std::min(std::sqrt(s), 1.0)) : 2 * std::asinh(std::sqrt(s));
    return k == 1 ? d / std::max(std::sin(d), 1e-8) : d / std::sinh(d);
  }

 private:
  static constexpr std::size_t terms = 9;

  // With s = sn^2(d/2) and G_j = 4^j j!^2/(2j + 1)!: d/sn d = sum of G_j (k s)^j, and
  // d^2 = 4 s sum of G_j/(j + 1) (k s)^j, since d(d^2/4)/ds = d/sn d.
  static constexpr std::array<double, terms> series = [] {
    std::array<double, terms> G = {1};
    for (std::size_t j = 1; j < G.size(); ++j)
      G[j] = G[j - 1] * static_cast<double>(2 * j) / static_cast<double>(2 * j + 1);
    return G;
  }();

  // The first `count` terms; the next one is below half a unit in the last place where they are used.
  template <std::size_t count>
  static Distance from_series(double s) {
    double squared = 0, over_sn = 0;
    for (std::size_t j = count; j-- > 0;) {
      squared = squared * (k * s) + series[j] / static_cast<double>(j + 1);
      over_sn = over_sn * (k * s) + series[j];
    }
    return {4 * s * squared, over_sn};
  }
};

}  // namespace orbitutte
