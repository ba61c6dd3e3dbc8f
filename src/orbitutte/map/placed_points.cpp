// SPDX-License-Identifier: MIT
#include "orbitutte/map/placed_points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

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

// A point with the digits of two doubles, and by how much each coordinate may be off.
struct FinePoint {
  Vector3Of<DoubleDouble> x;
  double error = 0;
};

double largest_of(const Vector3Of<DoubleDouble>& v) {
  return std::max({std::abs(v[0].high()), std::abs(v[1].high()), std::abs(v[2].high())});
}

// A product of a matrix and a vector is off by what both are, and by 14 u^2 of the sum of its terms.
FinePoint fine_point(const ElementTable& elements, const PlacedPoint& p) {
  FinePoint here = {p.sites->fine(p.site), p.sites->fine_error(p.site)};
  if (p.element == ElementTable::identity) return here;
  const double size = elements.rough(p.element).matrix().cwiseAbs().maxCoeff(),
               sum = p.sites->rough(p.site).cwiseAbs().sum();
  return {elements.fine(p.element) * here.x, size * (3 * here.error + 32 * DoubleDouble::unit * sum)};
}

// As in doubles. Rounding: 26 u^2 of twice every term of p . (u x v), and what the sum of three of them
// loses.
struct FineDeterminant {
  DoubleDouble value;
  double error = 0;
};

FineDeterminant fine_determinant(const FinePoint& p, const FinePoint& q, const FinePoint& r) {
  constexpr double unit = 64 * DoubleDouble::unit;
  const Vector3Of<DoubleDouble> u = q.x - p.x, v = r.x - p.x;
  const double size = largest_of(p.x), of_u = largest_of(u), of_v = largest_of(v),
               error_u = p.error + q.error + 4 * DoubleDouble::unit * of_u,
               error_v = p.error + r.error + 4 * DoubleDouble::unit * of_v;
  const double error = 6 * (size * (of_u * error_v + of_v * error_u + error_u * error_v) +
                            p.error * of_u * of_v + unit * size * of_u * of_v) +
                       1e-290;
  return {p.x.dot(u.cross(v)), error};
}

// The sign, or 0 if it may be any.
int sign_of(const FineDeterminant& determinant) {
  if (!(std::abs(determinant.value.high()) > determinant.error)) return 0;
  return determinant.value.high() > 0 ? 1 : -1;
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

// How small a number of 320 bits may become against its terms, and still have its digits: elsewhere those of
// all bits are taken, if there are more.
enum class Trust { always, where_enough_is_left };

template <typename Real>
Real least_of(const Real& terms, Trust trust) {
  constexpr int bits = -200;
  return trust == Trust::always ? Real(0) : Real(ldexp(terms, bits));
}

// NaN if too little is left.
template <typename Real>
Vector3 precise_coordinates(const ElementTable& elements, const std::array<PlacedPoint, 3>& corners,
                            const PlacedPoint& point, Trust trust) {
  std::array<Vector3Of<Real>, 3> x;
  for (int k = 0; k < 3; ++k) x[k] = Digits<Real>::of(elements, corners[k]);
  const Vector3Of<Real> p = Digits<Real>::of(elements, point);
  const Real size = std::max({largest_of<Real>(x[0]), largest_of<Real>(x[1]), largest_of<Real>(x[2])});
  Vector3Of<Real> weights;
  for (int k = 0; k < 3; ++k) {
    weights[k] = p.dot(x[(k + 1) % 3].cross(x[(k + 2) % 3]));
    if (weights[k] < 0) weights[k] = 0;
  }
  const Real sum = weights[0] + weights[1] + weights[2];
  if (!(sum > least_of<Real>(largest_of<Real>(p) * size * size, trust)))
    return Vector3::Constant(std::numeric_limits<double>::quiet_NaN());
  return {static_cast<double>(Real(weights[0] / sum)), static_cast<double>(Real(weights[1] / sum)),
          static_cast<double>(Real(weights[2] / sum))};
}

// Nothing if doubles do not have the digits, nor do two of them.
std::optional<Vector3> fine_coordinates(const ElementTable& elements,
                                        const std::array<PlacedPoint, 3>& corners, const PlacedPoint& point) {
  constexpr double enough = 1e-17;
  std::array<FinePoint, 3> x;
  for (int k = 0; k < 3; ++k) x[k] = fine_point(elements, corners[k]);
  const FinePoint p = fine_point(elements, point);
  Vector3 weights;
  double error = 0;
  for (int k = 0; k < 3; ++k) {
    const FineDeterminant fine = fine_determinant(p, x[(k + 1) % 3], x[(k + 2) % 3]);
    weights[k] = std::max(fine.value.high(), 0.0);
    error += fine.error;
  }
  const double sum = weights.sum();
  if (!(error <= enough * sum)) return std::nullopt;
  return weights / sum;
}

// Of the crossing of a line with an edge: the weights of the edge's ends, with the sum positive; and the size
// of their terms.
template <typename Real>
struct EdgeWeightsOf {
  Real from, to, terms;
};

template <typename Real>
EdgeWeightsOf<Real> crossing_weights(const ElementTable& elements, const LineThrough& edge,
                                     const LineThrough& line) {
  const Vector3Of<Real> a = Digits<Real>::of(elements, edge.from), b = Digits<Real>::of(elements, edge.to),
                        c = Digits<Real>::of(elements, line.from), d = Digits<Real>::of(elements, line.to);
  const Vector3Of<Real> through = c.cross(d);
  const Real from = through.dot(b), to = -through.dot(a),
             terms = std::max(largest_of<Real>(a), largest_of<Real>(b)) * largest_of<Real>(c) *
                     largest_of<Real>(d);
  if (from + to < 0) return {-from, -to, terms};
  return {from, to, terms};
}

// NaN if too little is left.
template <typename Real>
double precise_share(const ElementTable& elements, const LineThrough& edge, const LineThrough& line,
                     Trust trust) {
  const EdgeWeightsOf<Real> weights = crossing_weights<Real>(elements, edge, line);
  const Real sum = weights.from + weights.to;
  if (trust == Trust::where_enough_is_left && !(sum > least_of<Real>(weights.terms, trust)))
    return std::numeric_limits<double>::quiet_NaN();
  return static_cast<double>(Real(weights.to / sum));
}

template <typename Real>
int precise_order(const std::array<EdgeWeightsOf<Real>, 2>& weights, const Real& terms) {
  const auto& [a, b] = weights;
  return sign_of<Real>(a.to * b.from - b.to * a.from, terms);
}

template <typename Real>
std::array<EdgeWeightsOf<Real>, 2> two_crossings(const ElementTable& elements, const LineThrough& edge,
                                                 const LineThrough& first, const LineThrough& second) {
  return {crossing_weights<Real>(elements, edge, first), crossing_weights<Real>(elements, edge, second)};
}

// The same beside the sums, which are what is left.
template <typename Real>
int precise_order(const ElementTable& elements, const LineThrough& edge, const LineThrough& first,
                  const LineThrough& second) {
  const auto weights = two_crossings<Real>(elements, edge, first, second);
  return precise_order<Real>(weights, (weights[0].from + weights[0].to) * (weights[1].from + weights[1].to));
}

// The weights as determinants of neighbours, which two doubles hold.
struct FineEdgeWeights {
  FineDeterminant from, to;

  DoubleDouble sum() const { return from.value + to.value; }
  double error() const { return from.error + to.error; }
};

FineEdgeWeights fine_weights(const ElementTable& elements, const LineThrough& edge, const LineThrough& line) {
  const FinePoint c = fine_point(elements, line.from), d = fine_point(elements, line.to);
  FineEdgeWeights weights = {fine_determinant(fine_point(elements, edge.to), c, d),
                             fine_determinant(fine_point(elements, edge.from), c, d)};
  weights.to.value = -weights.to.value;
  if (!(weights.sum().high() < 0)) return weights;
  return {{-weights.from.value, weights.from.error}, {-weights.to.value, weights.to.error}};
}

// Nothing if two doubles do not have the digits.
std::optional<double> fine_share(const ElementTable& elements, const LineThrough& edge,
                                 const LineThrough& line) {
  constexpr double enough = 1e-17;
  const FineEdgeWeights weights = fine_weights(elements, edge, line);
  const DoubleDouble sum = weights.sum();
  if (!(2 * weights.error() <= enough * sum.high())) return std::nullopt;
  return static_cast<double>(weights.to.value / sum);
}

// The sign, or 0 if it may be any: products are off by what each factor is, and by 16 u^2 of themselves.
int fine_order(const ElementTable& elements, const LineThrough& edge, const LineThrough& first,
               const LineThrough& second) {
  const FineEdgeWeights a = fine_weights(elements, edge, first), b = fine_weights(elements, edge, second);
  if (!(a.sum().high() > 2 * a.error()) || !(b.sum().high() > 2 * b.error())) return 0;
  const auto size = [](const FineDeterminant& weight) {
    return std::abs(weight.value.high()) + weight.error;
  };
  const double of_a = size(a.from) + size(a.to), of_b = size(b.from) + size(b.to);
  return sign_of(FineDeterminant{
      a.to.value * b.from.value - b.to.value * a.from.value,
      2 * (of_a * b.error() + of_b * a.error()) + 64 * DoubleDouble::unit * of_a * of_b + 1e-290});
}

}  // namespace

int Sites::append(const Vector3& doubles) {
  rough_.push_back(doubles);
  exact_of_.push_back(-1);
  return count() - 1;
}

void Sites::set_exact(int site, const Vector3Of<MostPrecise>& position) {
  rough_[site] = position.cast<double>();
  const Vector3 rest = (position - rough_[site].cast<MostPrecise>()).cast<double>();
  const Digits digits = {rest, position.cast<Precise>(), position};
  if (exact_of_[site] >= 0) {
    digits_[exact_of_[site]] = digits;
    return;
  }
  exact_of_[site] = static_cast<int>(digits_.size());
  digits_.push_back(digits);
}

double Sites::error(int site) const { return is_double(site) ? 0 : 2 * half_unit * largest(rough_[site]); }

Vector3Of<DoubleDouble> Sites::fine(int site) const {
  const Vector3& x = rough_[site];
  if (is_double(site)) return {x[0], x[1], x[2]};
  const Vector3& rest = digits_[exact_of_[site]].rest;
  return {DoubleDouble::sum(x[0], rest[0]), DoubleDouble::sum(x[1], rest[1]),
          DoubleDouble::sum(x[2], rest[2])};
}

double Sites::fine_error(int site) const {
  return is_double(site) ? 0 : 2 * DoubleDouble::unit * largest(rough_[site]);
}

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

// Are the digits of both the same? Those of most points differ in their doubles.
bool ExactSigns::are_same(const PlacedPoint& p, const PlacedPoint& q) const {
  if (p.rough != q.rough || p.element != q.element) return false;
  if (p.sites == q.sites && p.site == q.site) return true;
  if (p.sites->is_double(p.site) && q.sites->is_double(q.site))
    return p.sites->rough(p.site) == q.sites->rough(q.site);
  return p.sites->exact(p.site) == q.sites->exact(q.site);
}

int ExactSigns::orientation(const PlacedPoint& p, const PlacedPoint& q, const PlacedPoint& r) const {
  const RoughDeterminant rough = rough_determinant(p, q, r);
  if (std::abs(rough.value) > rough.error) return rough.value > 0 ? 1 : -1;
  if (are_same(p, q) || are_same(q, r) || are_same(r, p)) return 0;
  const int fine =
      sign_of(fine_determinant(fine_point(elements_, p), fine_point(elements_, q), fine_point(elements_, r)));
  if (fine != 0) return fine;
  if (is_plain(p) && is_plain(q) && is_plain(r)) return orientation_sign(p.rough, q.rough, r.rough);
  const std::array<const PlacedPoint*, 3> points = {&p, &q, &r};
  const int sign = determinant_sign<Precise>(elements_, points);
  return sign != 0 || !all_digits_ ? sign : determinant_sign<MostPrecise>(elements_, points);
}

Vector3 ExactSigns::coordinates(const std::array<PlacedPoint, 3>& corners, const PlacedPoint& point) const {
  if (const std::optional<Vector3> fine = fine_coordinates(elements_, corners, point)) return *fine;
  if (!all_digits_) return precise_coordinates<Precise>(elements_, corners, point, Trust::always);
  const Vector3 precise =
      precise_coordinates<Precise>(elements_, corners, point, Trust::where_enough_is_left);
  return precise.allFinite() ? precise
                             : precise_coordinates<MostPrecise>(elements_, corners, point, Trust::always);
}

ExactSigns::Share ExactSigns::share(const LineThrough& edge, const LineThrough& line) const {
  constexpr double enough = 1e-13, rounding = 1e-15;
  const RoughDeterminant from = rough_determinant(edge.to, line.from, line.to),
                         to = rough_determinant(edge.from, line.from, line.to);
  const double sum = from.value - to.value, error = 2 * (from.error + to.error);
  if (error <= enough * std::abs(sum))
    return {std::clamp(-to.value / sum, 0.0, 1.0), error / std::abs(sum) + rounding};
  return {std::clamp(share_with_digits(edge, line), 0.0, 1.0), rounding};
}

double ExactSigns::share_with_digits(const LineThrough& edge, const LineThrough& line) const {
  if (const std::optional<double> fine = fine_share(elements_, edge, line)) return *fine;
  if (!all_digits_) return precise_share<Precise>(elements_, edge, line, Trust::always);
  const double precise = precise_share<Precise>(elements_, edge, line, Trust::where_enough_is_left);
  return std::isfinite(precise) ? precise : precise_share<MostPrecise>(elements_, edge, line, Trust::always);
}

int ExactSigns::compare_shares(const LineThrough& edge, const LineThrough& first,
                               const LineThrough& second) const {
  if (const int fine = fine_order(elements_, edge, first, second); fine != 0) return fine;
  if (!all_digits_) return precise_order<Precise>(elements_, edge, first, second);
  const auto weights = two_crossings<Precise>(elements_, edge, first, second);
  const int sign = precise_order<Precise>(weights, weights[0].terms * weights[1].terms);
  return sign != 0 ? sign : precise_order<MostPrecise>(elements_, edge, first, second);
}

}  // namespace orbitutte
