// SPDX-License-Identifier: MIT
// Sums after J. R. Shewchuk, "Adaptive precision floating-point arithmetic and fast robust geometric
// predicates", Discrete & Computational Geometry 18 (1997), section 2: expansions.
#include "orbitutte/orbifold/exact_positions.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <numeric>

#include "orbitutte/geometry/geodesic_triangle.h"
#include "orbitutte/geometry/orientation.h"

namespace orbitutte {
namespace {

using Rational = boost::multiprecision::cpp_rational;

// The power of two that brings the largest entry to between 1/2 and 1; 1 where there is none.
double scale_to_one(const Vector3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  if (!(largest > 0)) return 1;
  return std::ldexp(1.0, -std::max(std::ilogb(largest) + 1, -1000));
}

// The sign of det[a ab ac] where rounding leaves no doubt, otherwise 0. The entries may each be off by 2^-53
// of themselves, and the differences are scaled, so that nothing underflows that counts.
int filtered_sign(const Vector3& a, const Vector3& ab, const Vector3& ac) {
  const Vector3 u = ab * scale_to_one(ab), v = ac * scale_to_one(ac);
  const double determinant = a.dot(u.cross(v));
  const double permanent = a.cwiseAbs().dot(Vector3(std::abs(u.y() * v.z()) + std::abs(u.z() * v.y()),
                                                    std::abs(u.z() * v.x()) + std::abs(u.x() * v.z()),
                                                    std::abs(u.x() * v.y()) + std::abs(u.y() * v.x())));
  const double bound = 2e-15 * permanent + 1e-290;
  return determinant > bound ? 1 : determinant < -bound ? -1 : 0;
}

int sign_of_determinant(const std::array<std::array<Rational, 3>, 3>& p) {
  const auto minor = [&](int i, int j) -> Rational { return p[1][i] * p[2][j] - p[1][j] * p[2][i]; };
  const Rational determinant = p[0][0] * minor(1, 2) + p[0][1] * minor(2, 0) + p[0][2] * minor(0, 1);
  return determinant.sign();
}

}  // namespace

ExactPositions::ExactPositions(const Embedding& embedding)
    : space_(embedding.space()), X_(embedding.positions) {
  const auto counts = [](const Offset& offset) { return !offset.d.isZero(0); };
  if (std::none_of(embedding.offsets.begin(), embedding.offsets.end(), counts)) return;
  start_.assign(X_.rows() + 1, 0);
  for (const Offset& offset : embedding.offsets) start_[offset.vertex + 1] += counts(offset);
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  offset_.resize(start_.back());
  std::vector<int> next = start_;
  for (const Offset& offset : embedding.offsets)
    if (counts(offset)) offset_[next[offset.vertex]++] = offset.d;
}

void ExactPositions::add_coordinate(int v, int i, double sign, ExactSum& sum) const {
  sum.add(sign * X_(v, i));
  if (!has_offsets(v)) return;
  for (int k = start_[v]; k < start_[v + 1]; ++k) sum.add(sign * offset_[k][i]);
}

Vector3Of<MostPrecise> ExactPositions::exact(int v) const {
  Vector3Of<MostPrecise> sum = X_.row(v).transpose().cast<MostPrecise>();
  if (has_offsets(v))
    for (int k = start_[v]; k < start_[v + 1]; ++k) sum += offset_[k].cast<MostPrecise>();
  return sum;
}

Vector3 ExactPositions::rounded(int v) const {
  if (!has_offsets(v)) return X_.row(v);
  Vector3 result;
  for (int i = 0; i < 3; ++i) {
    ExactSum sum;
    add_coordinate(v, i, 1, sum);
    result[i] = sum.rounded();
  }
  return result;
}

Vector3 ExactPositions::exact_difference(int from, int to) const {
  Vector3 result;
  for (int i = 0; i < 3; ++i) {
    ExactSum sum;
    add_coordinate(to, i, 1, sum);
    add_coordinate(from, i, -1, sum);
    result[i] = sum.rounded();
  }
  return result;
}

double ExactPositions::chord(int a, int b) const {
  const Vector3 d = difference(a, b);
  const double scale = scale_to_one(d);
  return space_.norm(d * scale) / scale;
}

double ExactPositions::distance(int a, int b) const {
  constexpr double flat = 1e-6;  // chords shorter than this are arcs to 1e-13 of their length
  if (has_offsets(a) || has_offsets(b))
    if (const double length = chord(a, b); length < flat) return length;
  return space_.distance(X_.row(a), X_.row(b));
}

double ExactPositions::area(int a, int b, int c) const {
  if (!has_offsets(a) && !has_offsets(b) && !has_offsets(c))
    return space_.area(X_.row(a), X_.row(b), X_.row(c));
  return visit_curvature(space_, [&](auto curvature) {
    return area_between(curvature, rounded(a), difference(a, b), difference(a, c));
  });
}

int ExactPositions::orientation(int a, int b, int c) const {
  if (!has_offsets(a) && !has_offsets(b) && !has_offsets(c))
    return orientation_sign(X_.row(a), X_.row(b), X_.row(c));
  if (const int sign = filtered_sign(rounded(a), difference(a, b), difference(a, c))) return sign;
  std::array<std::array<Rational, 3>, 3> p;
  for (int corner = 0; corner < 3; ++corner) {
    const int v = std::array<int, 3>{a, b, c}[corner];
    for (int i = 0; i < 3; ++i) {
      p[corner][i] = Rational(X_(v, i));
      if (!has_offsets(v)) continue;
      for (int k = start_[v]; k < start_[v + 1]; ++k) p[corner][i] += Rational(offset_[k][i]);
    }
  }
  return sign_of_determinant(p);
}

double ExactPositions::rounding(int v) const {
  constexpr double unit = std::numeric_limits<double>::epsilon();
  if (!has_offsets(v)) return unit;
  double least = 1;
  for (int k = start_[v]; k < start_[v + 1]; ++k) least = std::min(least, offset_[k].cwiseAbs().maxCoeff());
  return unit * least;
}

void store(Embedding& embedding, int v, const Vector3Of<MostPrecise>& position, int offsets) {
  Vector3 part = position.cast<double>();
  embedding.positions.row(v) = part;
  Vector3Of<MostPrecise> rest = position;
  for (int k = 0; k < offsets; ++k) {
    rest -= part.cast<MostPrecise>();
    part = rest.cast<double>();
    embedding.offsets.push_back({v, part});
  }
}

}  // namespace orbitutte
