// SPDX-License-Identifier: MIT
#include "orbitutte/quotient/moebius.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>

namespace orbitutte {
namespace {

using PointPair = Eigen::Vector2cd;  // numerator, denominator

PointPair pair_of(const ChartPoint& point) { return {point.numerator, point.denominator}; }

// Takes infinity, 0 and 1 to the three points.
Eigen::Matrix2cd from_standard_points(const std::array<ChartPoint, 3>& points) {
  Eigen::Matrix2cd ends;
  ends << pair_of(points[0]), pair_of(points[1]);
  const PointPair shares = ends.partialPivLu().solve(pair_of(points[2]));
  return ends * shares.asDiagonal();
}

// The matrix whose eigenvectors are the points at u and -u, with the eigenvalues 1 and -1.
Eigen::Matrix2cd boost_generator(const Vector3& u) {
  Eigen::Matrix2cd result;
  result << Complex(-u.z()), Complex(u.x(), u.y()), Complex(u.x(), -u.y()), Complex(u.z());
  return result;
}

}  // namespace

ChartPoint chart_point_of(const Vector3& unit) {
  const Complex xy(unit.x(), unit.y());
  if (unit.z() >= 0) return {xy, 1 + unit.z(), nullptr};
  return {1 - unit.z(), std::conj(xy), nullptr};
}

Moebius Moebius::through(const std::array<ChartPoint, 3>& from, const std::array<ChartPoint, 3>& to) {
  return Moebius(from_standard_points(to) * from_standard_points(from).inverse());
}

Moebius Moebius::boost(const Vector3& velocity) {
  const double t = velocity.norm();
  if (!(t > 0)) return {};
  return Moebius(std::cosh(t / 2) * Eigen::Matrix2cd::Identity() +
                 std::sinh(t / 2) * boost_generator(velocity / t));
}

Moebius Moebius::rotation(const Matrix3& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return Moebius(std::cos(turn.angle() / 2) * Eigen::Matrix2cd::Identity() -
                 Complex(0, std::sin(turn.angle() / 2)) * boost_generator(turn.axis()));
}

Vector3Of<Precise> Moebius::precise_image(const ChartPoint& point) const {
  const PreciseComplex n = point.precise ? point.precise->numerator : with_digits(point.numerator),
                       d = point.precise ? point.precise->denominator : with_digits(point.denominator);
  const auto row = [&](int k) { return with_digits(matrix_(k, 0)) * n + with_digits(matrix_(k, 1)) * d; };
  const PreciseComplex a = row(0), b = row(1);
  const Precise upper = b.re * b.re + b.im * b.im, lower = a.re * a.re + a.im * a.im, sum = upper + lower;
  return {2 * (a.re * b.re + a.im * b.im) / sum, 2 * (a.im * b.re - a.re * b.im) / sum,
          (upper - lower) / sum};
}

ChartPoint Moebius::operator()(const ChartPoint& point) const {
  const PointPair image = matrix_ * pair_of(point);
  const double size = image.cwiseAbs().maxCoeff();
  return {image[0] / size, image[1] / size, nullptr};
}

}  // namespace orbitutte
