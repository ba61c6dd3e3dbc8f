// SPDX-License-Identifier: MIT
// The scale: A. Eremenko, "Metrics of positive curvature with conic singularities on the sphere", Proceedings
// of the AMS 132 (2004), after H. A. Schwarz. The variable w: D. Pappadopulo, S. Rychkov, J. Espin, R.
// Rattazzi, "Operator product expansion convergence in conformal field theory", Physical Review D 86 (2012).
#include "orbitutte/cones/cone_metric.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numbers>

#include "orbitutte/errors.h"

namespace orbitutte {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

// 2F1(p, q; c; z).
struct Hypergeometric {
  double p, q, c;

  // At z = 1, by Gauss's theorem.
  double at_one() const {
    return std::tgamma(c) * std::tgamma(c - p - q) / (std::tgamma(c - p) * std::tgamma(c - q));
  }
};

// The first coefficients f of 2F1 as a series in w, z = 4 w/(1 + w)^2. With D = w d/dw its equation reads
//   (1 + w)(1 - w^2) D^2 f + (1 + w)((c - 1)(1 + w^2) + (2 c - 4 p - 4 q) w) D f - 4 p q w (1 - w) f = 0.
template <typename Series>
Series series_in_w(const Hypergeometric& F) {
  const double d = F.c - 1, e = d + 2 * F.c - 4 * (F.p + F.q), pq = 4 * F.p * F.q;
  Series f = {1};
  for (int n = 1; n < static_cast<int>(f.size()); ++n) {
    const auto before = [&](int k) { return n >= k ? f[n - k] : 0.0; };
    const double m = n - 1, l = n - 2, k = n - 3;
    f[n] = -(before(1) * (m * m + e * m - pq) + before(2) * (-l * l + e * l + pq) +
             before(3) * (-k * k + d * k)) /
           (n * (n + d));
  }
  return f;
}

template <typename Series>
Complex sum(const Series& f, Complex w) {
  Complex result = 0;
  for (std::size_t n = f.size(); n-- > 0;) result = result * w + f[n];
  return result;
}

// The side between the corners with the angles pi a and pi b of a spherical triangle.
double side_between(double a, double b, double g) {
  const double cosine =
      (std::cos(pi * g) + std::cos(pi * a) * std::cos(pi * b)) / (std::sin(pi * a) * std::sin(pi * b));
  return std::acos(std::clamp(cosine, -1.0, 1.0));
}

void require_triangle(const std::array<double, 3>& a) {
  const double excess = a[0] + a[1] + a[2] - 1, least = std::min({a[0], a[1], a[2]}),
               greatest = std::max({a[0], a[1], a[2]});
  if (least > 0 && greatest < 1 && excess > 0 && excess < 2 * least) return;
  throw ArgumentError(fmt::format("no spherical triangle has the angles {:.6g} pi, {:.6g} pi and {:.6g} pi",
                                  a[0], a[1], a[2]));
}

struct Ranks {
  int least, middle, greatest;
};

// Of three numbers, by a table: there is nothing in their order that a processor could foresee.
Ranks ranks(const std::array<double, 3>& key) {
  static constexpr Ranks of_comparisons[8] = {{0, 1, 2}, {1, 0, 2}, {0, 2, 1}, {},
                                              {},        {1, 2, 0}, {2, 0, 1}, {2, 1, 0}};
  const int comparisons = (key[0] > key[1]) | ((key[1] > key[2]) << 1) | ((key[0] > key[2]) << 2);
  return of_comparisons[comparisons];
}

// In [0, pi].
double unsigned_angle(double angle) {
  constexpr double rounds = 6755399441055744.0;  // 1.5 * 2^52, which leaves no digits behind the point
  const double turns = (angle / (2 * pi) + rounds) - rounds;
  return std::abs(angle - 2 * pi * turns);
}

}  // namespace

ConeMetric::Numbering ConeMetric::number(double a, double b, double g) {
  const double p = (1 - a - b - g) / 2, q = (1 - a - b + g) / 2;
  const Hypergeometric F1 = {p, q, 1 - a}, F2 = {p + a, q + a, 1 + a};
  Numbering result;
  result.a = a;
  result.b = b;
  result.C = std::tan(side_between(a, b, g) / 2) * F1.at_one() / F2.at_one();
  result.log_factor = std::log(2 * result.C * a);
  result.F1 = series_in_w<Series>(F1);
  result.F2 = series_in_w<Series>(F2);
  result.fill_table();
  return result;
}

ConeMetric::ConeMetric(const std::array<double, 3>& angles) : angles_(angles) {
  require_triangle(angles);
  std::map<std::pair<double, double>, const Numbering*> known;  // by the angles at 0 and infinity
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) {
      if (i == k) continue;
      const Numbering*& same = known[{angles[i], angles[k]}];
      numbering_[3 * i + k] = same ? *same : number(angles[i], angles[3 - i - k], angles[k]);
      same = &numbering_[3 * i + k];
    }
}

double ConeMetric::Numbering::log_denominator(double radius_to_a, Complex z) const {
  const Complex root = 1.0 + std::sqrt(1.0 - z), w = z / (root * root);
  return std::log(std::norm(sum(F1, w)) + C * C * radius_to_a * radius_to_a * std::norm(sum(F2, w)));
}

void ConeMetric::Numbering::fill_table() {
  table.resize(static_cast<std::size_t>(radii + 1) * (directions + 1));
  for (int i = 0; i <= radii; ++i)
    for (int j = 0; j <= directions; ++j) {
      const double t = static_cast<double>(i) / radii;
      const Complex z = std::polar(std::pow(t, 1 / a), pi / 2 * j / directions);
      table[i * (directions + 1) + j] = static_cast<float>(log_denominator(t, z));
    }
}

inline double ConeMetric::Numbering::table_value(double radius_to_a, double direction) const {
  const double x = std::min(radius_to_a, 1.0) * radii, y = std::min(direction * (2 / pi), 1.0) * directions;
  const int i = std::min(static_cast<int>(x), radii - 1), j = std::min(static_cast<int>(y), directions - 1);
  const double s = x - i, t = y - j;
  const float* row = table.data() + i * (directions + 1) + j;
  const float* next = row + directions + 1;
  return (1 - s) * ((1 - t) * row[0] + t * row[1]) + s * ((1 - t) * next[0] + t * next[1]);
}

double ConeMetric::log_scale(const ConeCoordinates& P) const {
  const auto [i, j, k] = ranks({std::norm(P[0]), std::norm(P[1]), std::norm(P[2])});
  const Numbering& n = numbering(i, k);
  const double to_zero = std::log(std::abs(P[i] / P[k])), to_one = std::log(std::abs(P[j] / P[k]));
  return n.log_factor + (n.a - 1) * to_zero + (n.b - 1) * to_one -
         n.log_denominator(std::exp(n.a * to_zero), -P[i] / P[k]) - 2 * std::log(std::abs(P[k]));
}

inline double ConeMetric::looked_up(const ConeCoordinates& logs) const {
  const auto [i, j, k] = ranks({logs[0].real(), logs[1].real(), logs[2].real()});
  const Numbering& n = numbering(i, k);
  const Complex log_z = logs[i] - logs[k];
  const double to_one = logs[j].real() - logs[k].real();
  const float log_radius = static_cast<float>(n.a * log_z.real());
  return n.log_factor + (n.a - 1) * log_z.real() + (n.b - 1) * to_one -
         n.table_value(std::exp(log_radius), unsigned_angle(log_z.imag() + pi)) - 2 * logs[k].real();
}

void ConeMetric::add_quick_log_scales(const std::array<const Complex*, 3>& logs,
                                      const ConeCoordinates& shifts, std::vector<double>& u) const {
  for (std::size_t s = 0; s < u.size(); ++s)
    u[s] += looked_up({logs[0][s] + shifts[0], logs[1][s] + shifts[1], logs[2][s] + shifts[2]});
}

double ConeMetric::area() const { return 2 * pi * (angles_[0] + angles_[1] + angles_[2] - 1); }

}  // namespace orbitutte
