// SPDX-License-Identifier: MIT
#include "orbitutte/map/placed_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "orbitutte/geometry/orientation.h"

namespace orbitutte {
namespace {

constexpr double half_unit = 0x1p-53;

double largest(const Vector3& v) { return v.cwiseAbs().maxCoeff(); }

// A determinant in doubles, and by how much it may be off.
struct RoughDeterminant {
  double value = 0, error = 0;
};

// p . ((q - p) x (r - p)): differences lose no digits between neighbours. Every term of the product is at
// most |p| |u| |v| in the largest norm, and there are six.
RoughDeterminant rough_determinant(const PlacedPoint& p, const PlacedPoint& q, const PlacedPoint& r) {
  const Vector3 u = q.rough - p.rough, v = r.rough - p.rough;
  const double size = largest(p.rough), of_u = largest(u), of_v = largest(v),
               error_u = p.error + q.error + half_unit * of_u, error_v = p.error + r.error + half_unit * of_v;
  const double error = 6 * (size * (of_u * error_v + of_v * error_u + error_u * error_v) +
                            p.error * of_u * of_v + 8 * half_unit * size * of_u * of_v) +
                       1e-290;
  return {p.rough.dot(u.cross(v)), error};
}

bool is_plain(const PlacedPoint& p) {
  return p.element == ElementTable::identity && p.sites->is_double(p.site);
}

// Points with so many digits.
template <typename Real>
struct Digits;

template <>
struct Digits<Precise> {
  static constexpr int zero = -250;
  static Vector3Of<Precise> of(const ElementTable& elements, const PlacedPoint& p) {
    const Vector3Of<Precise> site = p.sites->precise(p.site);
    return p.element == ElementTable::identity ? site
                                               : Vector3Of<Precise>(elements.precise(p.element) * site);
  }
};

template <>
struct Digits<MostPrecise> {
  static constexpr int zero = -2000;
  static Vector3Of<MostPrecise> of(const ElementTable& elements, const PlacedPoint& p) {
    const Vector3Of<MostPrecise> site = p.sites->exact(p.site);
    return p.element == ElementTable::identity ? site
                                               : Vector3Of<MostPrecise>(elements.exact(p.element) * site);
  }
};

template <typename Real>
Real largest_of(const Vector3Of<Real>& v) {
  return std::max({Real(abs(v[0])), Real(abs(v[1])), Real(abs(v[2]))});
}

// The sign, zero if the number is below 2^zero of its terms.
template <typename Real>
int sign_of(const Real& value, const Real& terms) {
  if (abs(value) <= ldexp(terms, Digits<Real>::zero)) return 0;
  return value > 0 ? 1 : -1;
}

template <typename Real>
int determinant_sign(const ElementTable& elements, const std::array<const PlacedPoint*, 3>& points) {
  const Vector3Of<Real> p = Digits<Real>::of(elements, *points[0]),
                        q = Digits<Real>::of(elements, *points[1]),
                        r = Digits<Real>::of(elements, *points[2]);
  const Real terms = largest_of<Real>(p) * largest_of<Real>(q) * largest_of<Real>(r);
  return sign_of<Real>(p.dot(q.cross(r)), terms);
}

template <typename Real>
Vector3 precise_coordinates(const ElementTable& elements, const std::array<PlacedPoint, 3>& corners,
                            const PlacedPoint& point) {
  std::array<Vector3Of<Real>, 3> x;
  for (int k = 0; k < 3; ++k) x[k] = Digits<Real>::of(elements, corners[k]);
  const Vector3Of<Real> p = Digits<Real>::of(elements, point);
  Vector3Of<Real> weights;
  for (int k = 0; k < 3; ++k) {
    weights[k] = p.dot(x[(k + 1) % 3].cross(x[(k + 2) % 3]));
    if (weights[k] < 0) weights[k] = 0;
  }
  const Real sum = weights[0] + weights[1] + weights[2];
  if (!(sum > 0)) return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  return {static_cast<double>(Real(weights[0] / sum)), static_cast<double>(Real(weights[1] / sum)),
          static_cast<double>(Real(weights[2] / sum))};
}

// Of the crossing of a line with an edge: the weights of the edge's ends, with the sum positive.
template <typename Real>
struct EdgeWeightsOf {
  Real from, to;
};

template <typename Real>
EdgeWeightsOf<Real> crossing_weights(const ElementTable& elements, const LineThrough& edge,
                                     const LineThrough& line) {
  const Vector3Of<Real> through = Vector3Of<Real>(Digits<Real>::of(elements, line.from))
                                      .cross(Vector3Of<Real>(Digits<Real>::of(elements, line.to)));
  const Real from = through.dot(Digits<Real>::of(elements, edge.to)),
             to = -through.dot(Digits<Real>::of(elements, edge.from));
  if (from + to < 0) return {-from, -to};
  return {from, to};
}

template <typename Real>
double precise_share(const ElementTable& elements, const LineThrough& edge, const LineThrough& line) {
  const EdgeWeightsOf<Real> weights = crossing_weights<Real>(elements, edge, line);
  return static_cast<double>(Real(weights.to / (weights.from + weights.to)));
}

template <typename Real>
int precise_order(const ElementTable& elements, const LineThrough& edge, const LineThrough& first,
                  const LineThrough& second) {
  const EdgeWeightsOf<Real> a = crossing_weights<Real>(elements, edge, first),
                            b = crossing_weights<Real>(elements, edge, second);
  const Real terms = (a.from + a.to) * (b.from + b.to);
  return sign_of<Real>(a.to * b.from - b.to * a.from, terms);
}

}  // namespace

int Sites::append(const Vector3& doubles) {
  rough_.push_back(doubles);
  exact_of_.push_back(-1);
  return count() - 1;
}

void Sites::set_exact(int site, const Vector3Of<MostPrecise>& position) {
  const Digits digits = {position.cast<Precise>(), position};
  rough_[site] = position.cast<double>();
  if (exact_of_[site] >= 0) {
    digits_[exact_of_[site]] = digits;
    return;
  }
  exact_of_[site] = static_cast<int>(digits_.size());
  digits_.push_back(digits);
}

double Sites::error(int site) const { return is_double(site) ? 0 : 2 * half_unit * largest(rough_[site]); }

Vector3Of<Precise> Sites::precise(int site) const {
  if (is_double(site)) return rough_[site].cast<Precise>();
  return digits_[exact_of_[site]].precise;
}

Vector3Of<MostPrecise> Sites::exact(int site) const {
  if (is_double(site)) return rough_[site].cast<MostPrecise>();
  return digits_[exact_of_[site]].exact;
}

PlacedPoint ExactSigns::placed(const Sites& sites, int site, int element) const {
  const Vector3 here = sites.rough(site);
  const double error = sites.error(site);
  if (element == ElementTable::identity) return {&sites, site, element, here, error};
  const Matrix3& matrix = elements_.rough(element).matrix();
  const double size = matrix.cwiseAbs().maxCoeff();
  return {&sites, site, element, matrix * here, size * (3 * error + 6 * half_unit * here.cwiseAbs().sum())};
}

int ExactSigns::orientation(const PlacedPoint& p, const PlacedPoint& q, const PlacedPoint& r) const {
  const RoughDeterminant rough = rough_determinant(p, q, r);
  if (std::abs(rough.value) > rough.error) return rough.value > 0 ? 1 : -1;
  if (is_plain(p) && is_plain(q) && is_plain(r)) return orientation_sign(p.rough, q.rough, r.rough);
  const std::array<const PlacedPoint*, 3> points = {&p, &q, &r};
  const int sign = determinant_sign<Precise>(elements_, points);
  return sign != 0 || !all_digits_ ? sign : determinant_sign<MostPrecise>(elements_, points);
}

Vector3 ExactSigns::coordinates(const std::array<PlacedPoint, 3>& corners, const PlacedPoint& point) const {
  constexpr double enough = 1e-13;
  Vector3 weights;
  double error = 0;
  for (int k = 0; k < 3; ++k) {
    const RoughDeterminant rough = rough_determinant(point, corners[(k + 1) % 3], corners[(k + 2) % 3]);
    weights[k] = std::max(rough.value, 0.0);
    error += rough.error;
  }
  if (error <= enough * weights.sum()) return weights / weights.sum();
  return all_digits_ ? precise_coordinates<MostPrecise>(elements_, corners, point)
                     : precise_coordinates<Precise>(elements_, corners, point);
}

ExactSigns::Share ExactSigns::share(const LineThrough& edge, const LineThrough& line) const {
  constexpr double enough = 1e-13, rounding = 1e-15;
  const RoughDeterminant from = rough_determinant(edge.to, line.from, line.to),
                         to = rough_determinant(edge.from, line.from, line.to);
  const double sum = from.value - to.value, error = 2 * (from.error + to.error);
  if (error <= enough * std::abs(sum))
    return {std::clamp(-to.value / sum, 0.0, 1.0), error / std::abs(sum) + rounding};
  const double value = all_digits_ ? precise_share<MostPrecise>(elements_, edge, line)
                                   : precise_share<Precise>(elements_, edge, line);
  return {std::clamp(value, 0.0, 1.0), rounding};
}

int ExactSigns::compare_shares(const LineThrough& edge, const LineThrough& first,
                               const LineThrough& second) const {
  return all_digits_ ? precise_order<MostPrecise>(elements_, edge, first, second)
                     : precise_order<Precise>(elements_, edge, first, second);
}

}  // namespace orbitutte
