// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/varying_isometry.h"

#include <Eigen/Geometry>

namespace orbitutte {

VaryingMotion VaryingMotion::none(Space space, Eigen::Index parameters, Order order) {
  const Eigen::Index pairs = order == Order::second ? parameters * parameters : 0;
  return {space, Eigen::Matrix3Xd::Zero(3, parameters), Eigen::Matrix3Xd::Zero(3, pairs)};
}

VaryingMotion VaryingMotion::operator*(const VaryingMotion& v) const {
  VaryingMotion result = {space, first + v.first, second + v.second};
  const Eigen::Index q = parameters();
  for (Eigen::Index a = 0; a < q && has_second(); ++a)
    for (Eigen::Index b = 0; b < q; ++b) {
      const Vector3 half = 0.5 * commutator(space, first.col(a), v.first.col(b));
      result.second.col(q * a + b) += half;
      result.second.col(q * b + a) += half;
    }
  return result;
}

VaryingMotion VaryingMotion::seen_through(const Isometry& g) const {
  const Matrix3 M = (g.reverses_orientation() ? -1 : 1) * g.matrix();
  return {space, M * first, M * second};
}

Eigen::Matrix3Xd VaryingMotion::velocities(const Vector3& point) const {
  Eigen::Matrix3Xd result(3, first.cols());
  for (Eigen::Index a = 0; a < result.cols(); ++a) result.col(a) = commutator(space, first.col(a), point);
  return result;
}

// exp(u) p = p + u p + u (u p)/2.
Eigen::Matrix3Xd VaryingMotion::accelerations(const Vector3& point) const {
  const Eigen::Matrix3Xd velocity = velocities(point);
  const Eigen::Index q = parameters();
  Eigen::Matrix3Xd result(3, second.cols());
  for (Eigen::Index a = 0; a < q && has_second(); ++a)
    for (Eigen::Index b = 0; b <= a; ++b)
      result.col(q * a + b) = result.col(q * b + a) =
          commutator(space, second.col(q * a + b), point) +
          0.5 * (commutator(space, first.col(a), velocity.col(b)) +
                 commutator(space, first.col(b), velocity.col(a)));
  return result;
}

Matrix3 infinitesimal_isometry(Space space, const Vector3& w) {
  const int k = space.curvature();
  Matrix3 result;
  result << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -k * w.y(), k * w.x(), 0;
  return result;
}

Vector3 infinitesimal_part(Space space, const Matrix3& M) {
  const int k = space.curvature();
  const double halves = 1 + k * k;  // entries that show x and y: two if the space is curved
  return {(k * M(2, 1) - M(1, 2)) / halves, (M(0, 2) - k * M(2, 0)) / halves, (M(1, 0) - M(0, 1)) / 2};
}

int closing_rows(Space space) { return space.curvature() == 0 ? 2 : 3; }

Vector3 commutator(Space space, const Vector3& u, const Vector3& v) {
  Vector3 result = u.cross(v);
  result.z() *= space.curvature();
  return result;
}

Eigen::Matrix<double, 3, 2> tangent_frame(Space space, const Vector3& p) {
  return space.to_origin(p).inverse_matrix().leftCols<2>();
}

// n x J v, with n = (k x, k y, z).
Vector3 moving(Space space, const Vector3& p, const Vector3& v) {
  const int k = space.curvature();
  const Vector3 n(k * p.x(), k * p.y(), p.z()), raised(v.x(), v.y(), k * v.z());
  return n.cross(raised);
}

}  // namespace orbitutte
