// SPDX-License-Identifier: MIT
// The metric of curvature 1 on the Riemann sphere with three cones, in closed form.
#pragma once

#include <array>
#include <complex>
#include <vector>

namespace orbitutte {

/// Three complex numbers whose sum is zero, up to a common factor: a point of the Riemann sphere by its place
/// relative to three others, at which one of them vanishes.
using ConeCoordinates = std::array<std::complex<double>, 3>;

/// The spherical metric with cones of the angles 2 pi a[0], 2 pi a[1], 2 pi a[2] where the coordinates P[0],
/// P[1], P[2] vanish: the double of the spherical triangle with the angles pi a[k].
///
/// With z = -P_i/P_k, which is 0, 1 and infinity at the cones i, j and k, and a, b, g their angles,
///     rho(z) = 2 C a |z|^(a-1) |1-z|^(b-1) / (|F1|^2 + C^2 |z|^(2a) |F2|^2),
///     F1 = 2F1(p, q; 1-a; z),  F2 = 2F1(p+a, q+a; 1+a; z),  p = (1-a-b-g)/2,  q = (1-a-b+g)/2,
///     C = tan(l/2) F1(1)/F2(1),  cos l = (cos pi g + cos pi a cos pi b)/(sin pi a sin pi b),
/// F1(1) and F2(1) by Gauss's theorem. Of the six ways to number the cones the one is taken for which |P_i|
/// is the least and |P_k| the greatest. In w = z/(1 + sqrt(1-z))^2 both series then converge like 0.27^n.
class ConeMetric {
 public:
  /// Angles in (0, 1). Throws ArgumentError unless 0 < a[0] + a[1] + a[2] - 1 < 2 min(a): otherwise there is
  /// no such triangle.
  explicit ConeMetric(const std::array<double, 3>& angles);

  /// log of the scale, relative to |P[0] dP[1] - P[1] dP[0]|, a form that is the same for any two of them.
  double log_scale(const ConeCoordinates& P) const;

  /// Adds the same to u for many points, by a table: 2e-4 off at most. logs[i][s] + shifts[i] are the
  /// logarithms log|P| + i arg P of P[i] at point s.
  void add_quick_log_scales(const std::array<const std::complex<double>*, 3>& logs,
                            const ConeCoordinates& shifts, std::vector<double>& u) const;

  /// By Gauss and Bonnet: 2 pi (a[0] + a[1] + a[2] - 1).
  double area() const;

  const std::array<double, 3>& angles() const { return angles_; }

 private:
  static constexpr int terms = 24, radii = 64, directions = 24;
  using Series = std::array<double, terms>;

  /// One way to number the cones: i at 0, j at 1, k at infinity.
  struct Numbering {
    double a = 0, b = 0, C = 0;

    /// log(2 C a).
    double log_factor = 0;

    /// The coefficients of F1 and F2 in powers of w.
    Series F1, F2;

    /// log(|F1|^2 + C^2 |z|^(2a) |F2|^2) at |z|^a = row/radii and |arg z| = pi/2 column/directions.
    std::vector<float> table;

    double log_denominator(double radius_to_a, std::complex<double> z) const;
    double table_value(double radius_to_a, double direction) const;
    void fill_table();
  };

  double looked_up(const ConeCoordinates& logs) const;
  static Numbering number(double a, double b, double g);
  const Numbering& numbering(int at_zero, int at_infinity) const {
    return numbering_[3 * at_zero + at_infinity];
  }

  std::array<double, 3> angles_;
  std::array<Numbering, 9> numbering_;
};

}  // namespace orbitutte
