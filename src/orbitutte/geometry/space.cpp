// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/space.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "orbitutte/geometry/geodesic_triangle.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

Matrix3 inverse_of_affine(const Matrix3& M) {
  Matrix3 inverse = Matrix3::Identity();
  inverse.topLeftCorner<2, 2>() = M.topLeftCorner<2, 2>().transpose();
  inverse.topRightCorner<2, 1>() = -inverse.topLeftCorner<2, 2>() * M.topRightCorner<2, 1>();
  return inverse;
}

Matrix3 inverse_in(int k, const Matrix3& M) {
  if (k == 0) return inverse_of_affine(M);
  Matrix3 inverse = M.transpose();
  inverse.topRightCorner<2, 1>() *= k;
  inverse.bottomLeftCorner<1, 2>() *= k;
  return inverse;
}

// Where a step from p leads: to the point on the line from the origin through p + step; in the hyperbolic
// plane, where that is no point for steps longer than one, to sqrt(1 + <v, v>) p + v, v the step's tangential
// part.
template <int k>
Vector3 stepped(Curvature<k> curvature, const Vector3& p, const Vector3& step) {
  if constexpr (k >= 0) return curvature.retract(p + step);
  const Vector3 v = curvature.tangent(p, step);
  return curvature.retract(std::sqrt(1 + curvature.dot(v, v)) * p + v);
}

Matrix3 cross_matrix(const Vector3& p) {
  Matrix3 result;
  result << 0, -p.z(), p.y(), p.z(), 0, -p.x(), -p.y(), p.x(), 0;
  return result;
}

}  // namespace

std::string Space::name() const { return k_ > 0 ? "spherical" : k_ == 0 ? "euclidean" : "hyperbolic"; }

double Space::dot(const Vector3& u, const Vector3& v) const {
  return visit_curvature(*this, [&](auto c) { return c.dot(u, v); });
}

double Space::norm(const Vector3& v) const { return std::sqrt(std::max(dot(v, v), 0.0)); }

Vector3 Space::tangent(const Vector3& p, const Vector3& v) const {
  return visit_curvature(*this, [&](auto c) -> Vector3 { return c.tangent(p, v); });
}

Vector3 Space::retract(const Vector3& p) const {
  return visit_curvature(*this, [&](auto c) -> Vector3 { return c.retract(p); });
}

// In the hyperbolic plane, rounding may leave a squared chord between neighbours below zero.
double Space::distance(const Vector3& p, const Vector3& q) const {
  return visit_curvature(*this, [&](auto c) { return std::sqrt(std::max(c.distance(p, q).squared, 0.0)); });
}

double Space::longest_unique() const {
  return k_ > 0 ? std::numbers::pi : std::numeric_limits<double>::infinity();
}

Vector3 Space::at(const Vector3& p, const Vector3& u, double d) const {
  if (k_ > 0) return std::cos(d) * p + std::sin(d) * u;
  if (k_ == 0) return p + d * u;
  return std::cosh(d) * p + std::sinh(d) * u;
}

Vector3 Space::turned_left(const Vector3& p, const Vector3& u) const {
  return metric().cwiseProduct(p.cross(u));
}

Vector3 Space::moved_along(const Vector3& v, const Vector3& p, const Vector3& q) const {
  return v - k_ * dot(v, q) / (1 + form(p, q)) * (p + q);
}

double Space::length_of_half_sn(double half_sn) const {
  if (k_ > 0) return 2 * std::asin(std::min(half_sn, 1.0));
  return 2 * (k_ == 0 ? half_sn : std::asinh(half_sn));
}

Vector3 Space::polar(double distance, double angle) const {
  return at(origin(), {std::cos(angle), std::sin(angle), 0}, distance);
}

Vector3 Space::lift(double x, double y) const {
  return {x, y, std::sqrt(std::max(1 - k_ * (x * x + y * y), 0.0))};
}

// The smaller root t of q(from + t direction) = 1 with q = k (x^2 + y^2) + z^2.
std::optional<double> Space::meeting(const Vector3& from, const Vector3& direction) const {
  const Vector3 weight(k_, k_, 1);
  const double a = direction.cwiseProduct(direction).dot(weight),
               b = from.cwiseProduct(direction).dot(weight), c = from.cwiseProduct(from).dot(weight) - 1;
  const double discriminant = b * b - a * c;
  if (!(discriminant >= 0) || !(a > 0)) return std::nullopt;
  return (-b - std::sqrt(discriminant)) / a;
}

double Space::defect(const Vector3& p) const {
  const double length = k_ > 0 ? p.norm() : std::sqrt(k_ * p.head<2>().squaredNorm() + p.z() * p.z());
  const double off = std::abs(length - 1);
  return off < std::numeric_limits<double>::infinity() && p.z() * (1 - k_) >= 0
             ? off
             : std::numeric_limits<double>::infinity();
}

double Space::tangential_rounding(const Vector3& p) const {
  Vector3 size = p.cwiseAbs();
  if (k_ <= 0) size.z() = std::numeric_limits<double>::infinity();
  std::sort(size.begin(), size.end());
  return std::numeric_limits<double>::epsilon() * size[1];
}

double Space::area(const Vector3& a, const Vector3& b, const Vector3& c) const {
  return visit_curvature(*this, [&](auto curvature) { return area_of(curvature, a, b, c); });
}

double Space::angle(const Vector3& p, const Vector3& q, const Vector3& r) const {
  const Vector3 u = tangent(p, q - p), v = tangent(p, r - p);
  return std::atan2(p.dot(u.cross(v)), dot(u, v));
}

double Space::side_opposite(double a, double b, double c) const {
  if (k_ == 0) return std::sin(a);
  const double cs = (std::cos(a) + std::cos(b) * std::cos(c)) / (std::sin(b) * std::sin(c));
  return k_ > 0 ? std::acos(cs) : std::acosh(cs);
}

Vector3 Space::normal(const Vector3& line) const {
  const Vector3 raised = metric().cwiseProduct(line);
  return raised / std::sqrt(line.dot(raised));
}

Isometry Space::isometry(const Matrix3& matrix) const { return {matrix, inverse_in(k_, matrix)}; }

double Space::isometry_defect(const Matrix3& matrix) const {
  if (!matrix.allFinite()) return std::numeric_limits<double>::infinity();
  const double off = (inverse_in(k_, matrix) * matrix - Matrix3::Identity()).cwiseAbs().maxCoeff();
  const Eigen::RowVector3d last = matrix.row(2);
  if (k_ == 0) return std::max(off, (last - Eigen::RowVector3d(0, 0, 1)).cwiseAbs().maxCoeff());
  return k_ < 0 && !(last.z() > 0) ? std::numeric_limits<double>::infinity() : off;  // the other sheet
}

Isometry Space::nearest_isometry(const Matrix3& matrix) const {
  return isometry(0.5 * matrix * (3 * Matrix3::Identity() - inverse_in(k_, matrix) * matrix));
}

// cos(a) x + (1 - cos(a)) (n . x) p + sin(a) J (p x x), with n = (k p_x, k p_y, p_z) and J = diag(1, 1, k):
// Rodrigues' formula for k = 1.
Isometry Space::rotation(const Vector3& point, double angle) const {
  const Eigen::RowVector3d n(k_ * point.x(), k_ * point.y(), point.z());
  const double cosine = std::cos(angle), sine = std::sin(angle);
  Matrix3 turn = cross_matrix(point);
  turn.row(2) *= k_;
  Matrix3 matrix = cosine * Matrix3::Identity() + (1 - cosine) * point * n + sine * turn;
  if (k_ == 0) matrix(2, 2) = 1;  // but for the rounding of (1 - cosine) + cosine, it is
  return isometry(matrix);
}

// x - 2 (m . x)/(m . m#) m#, with m# = J m.
Isometry Space::reflection(const Vector3& line) const {
  const Vector3 raised = metric().cwiseProduct(line);
  const Matrix3 matrix = Matrix3::Identity() - 2 / line.dot(raised) * raised * line.transpose();
  return {matrix, matrix};
}

Isometry Space::to_origin(const Vector3& p) const {
  const Vector3 sum = p + origin();
  // Opposite to the origin, every point of the equator is midway.
  const Vector3 middle = sum.norm() > 1e-8 ? retract(sum) : Vector3(Vector3::UnitX());
  return rotation(middle, std::numbers::pi);
}

Room Space::room() const { return Matrix3::Identity().leftCols(k_ == 0 ? 2 : 3); }

Room Space::room_on(const Isometry& reflection) const {
  // I - M is a multiple of m# m^T.
  const Matrix3 difference = Matrix3::Identity() - reflection.matrix();
  Eigen::Index row = 0;
  difference.rowwise().squaredNorm().maxCoeff(&row);
  Vector3 line = difference.row(row).transpose().normalized();
  if (k_ == 0) return Vector3(-line.y(), line.x(), 0).normalized();
  Room room(3, 2);
  room.col(0) = line.unitOrthogonal();
  room.col(1) = line.cross(Vector3(room.col(0)));
  return room;
}

void move_points(Space space, const Points& positions, const Points& directions, double step, Points& moved) {
  moved.resize(positions.rows(), 3);
  visit_curvature(space, [&](auto curvature) {
    parallel_ranges(static_cast<int>(positions.rows()), [&](int begin, int end) {
      for (int v = begin; v < end; ++v)
        moved.row(v) = stepped(curvature, positions.row(v), step * directions.row(v));
    });
  });
}

void lower_rows(Space space, Points& vectors) { vectors.col(2) *= space.metric().z(); }

void retract_points(Space space, Points& positions) {
  visit_curvature(space, [&](auto curvature) {
    for (Eigen::Index v = 0; v < positions.rows(); ++v)
      positions.row(v) = curvature.retract(positions.row(v));
  });
}

}  // namespace orbitutte
