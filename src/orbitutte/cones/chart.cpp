// SPDX-License-Identifier: MIT
#include "orbitutte/cones/chart.h"

#include <algorithm>
#include <cmath>

#include "orbitutte/orbifold/families.h"

namespace orbitutte {
namespace {

// Number is Real's complex numbers: Complex or PreciseComplex.

template <typename Number>
struct Ratio {
  Number numerator, denominator;
};

// The larger one becomes 1.
template <typename Number>
Ratio<Number> normalised(const Ratio<Number>& ratio) {
  const Number one = {1, 0};
  if (std::abs(to_double(ratio.numerator)) > std::abs(to_double(ratio.denominator)))
    return {one, ratio.denominator / ratio.numerator};
  return {ratio.numerator / ratio.denominator, one};
}

// Z = (w^2 + 1)^2/(4 w^2) of a point of the unit sphere, w = (x + iy)/(1 + z) = (1 - z)/(x - iy).
template <typename Number, typename Real>
Ratio<Number> invariant(const Vector3Of<Real>& p) {
  const Real &x = p[0], &y = p[1], &z = p[2];
  const Real one = 1, minus_y = -y;
  const bool is_upper = z >= 0;
  const Number a = is_upper ? Number{x, y} : Number{one - z, Real(0)},
               b = is_upper ? Number{one + z, Real(0)} : Number{x, minus_y};
  const Number s = a * a + b * b, ab = a * b, t = ab + ab;
  return normalised<Number>({s * s, t * t});
}

// That of a point on the ray through p.
ChartPoint chart_point(const Vector3& p) {
  const Ratio<Complex> Z = invariant<Complex, double>(p.normalized());
  return {Z.numerator, Z.denominator, nullptr};
}

ChartPoint precise_chart_point(const Vector3Of<Precise>& p) {
  const Precise length = sqrt(p.dot(p));
  const Ratio<PreciseComplex> Z = invariant<PreciseComplex, Precise>(p / length);
  return {to_double(Z.numerator), to_double(Z.denominator),
          std::make_shared<PreciseChartPoint>(PreciseChartPoint{Z.numerator, Z.denominator})};
}

}  // namespace

ChartPoint exact_point(double numerator, double denominator) {
  return {numerator, denominator,
          std::make_shared<PreciseChartPoint>(PreciseChartPoint{{numerator, 0}, {denominator, 0}})};
}

Complex bracket(const ChartPoint& a, const ChartPoint& b) {
  if (!a.precise || !b.precise) return a.numerator * b.denominator - b.numerator * a.denominator;
  const PreciseChartPoint &p = *a.precise, &q = *b.precise;
  return to_double(p.numerator * q.denominator - q.numerator * p.denominator);
}

ChartPoint conjugate(const ChartPoint& point) {
  ChartPoint result = {std::conj(point.numerator), std::conj(point.denominator), nullptr};
  if (!point.precise) return result;
  const auto turned = [](const PreciseComplex& a) { return PreciseComplex{a.re, Precise(-a.im)}; };
  result.precise = std::make_shared<PreciseChartPoint>(
      PreciseChartPoint{turned(point.precise->numerator), turned(point.precise->denominator)});
  return result;
}

Vector3 sphere_point(const ChartPoint& point) {
  const double n = std::norm(point.numerator), d = std::norm(point.denominator);
  const Complex xy = 2.0 * point.numerator * std::conj(point.denominator) / (n + d);
  return {xy.real(), xy.imag(), (d - n) / (n + d)};
}

bool has_orbifold_chart(const Target& target) { return is_of_three_half_turns(target.symbol); }

OrbifoldChart::OrbifoldChart(const Embedding& embedding)
    : embedding_(embedding), positions_(embedding), to_canonical_(embedding.placement.inverse().matrix()) {
  if (!has_orbifold_chart(embedding.target))
    throw ArgumentError("the chart of a surface is made from a map to 222 or *222, not to " +
                        embedding.target.signature);
}

bool OrbifoldChart::needs_digits(int v) const {
  constexpr double near = 1e-5;  // of an axis: Z then differs from that of the axis by 1e-10
  if (positions_.has_offsets(v)) return true;
  Vector3 size = embedding_.positions.row(v).cwiseAbs();
  std::sort(size.begin(), size.end());
  return size[1] < near;
}

Vector3Of<Precise> OrbifoldChart::precise_position(int v) const {
  Vector3Of<Precise> sum = embedding_.positions.row(v).transpose().cast<Precise>();
  if (positions_.has_offsets(v)) {
    const Vector3Of<MostPrecise> exact = positions_.exact(v);
    for (int i = 0; i < 3; ++i) sum[i] = Precise(exact[i]);
  }
  return to_canonical_.cast<Precise>() * sum;
}

ChartPoint OrbifoldChart::of_vertex(int v) const {
  if (needs_digits(v)) return precise_chart_point(precise_position(v));
  return chart_point(to_canonical_ * embedding_.positions.row(v).transpose());
}

ChartPoint OrbifoldChart::of_triangle(int f) const {
  const auto v = embedding_.triangles.row(f);
  if (needs_digits(v[0]) || needs_digits(v[1]) || needs_digits(v[2])) {
    const Vector3Of<Precise> sum = precise_position(v[0]) + precise_position(v[1]) + precise_position(v[2]);
    return precise_chart_point(sum);
  }
  const Points& X = embedding_.positions;
  return chart_point(to_canonical_ * (X.row(v[0]) + X.row(v[1]) + X.row(v[2])).transpose());
}

}  // namespace orbitutte
