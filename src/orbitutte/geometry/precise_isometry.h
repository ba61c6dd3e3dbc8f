// SPDX-License-Identifier: MIT
// Isometries of the three geometries (Space) with as many digits as are wanted: Real is double or one of the
// numbers of precise.h.
#pragma once

#include <Eigen/Geometry>
#include <cmath>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// J m of a covector m, with J = diag(1, 1, k): where the reflection in the line m . p = 0 moves points.
template <typename Real>
Vector3Of<Real> precise_raised(Space space, const Vector3Of<Real>& line) {
  return {line.x(), line.y(), space.curvature() * line.z()};
}

/// The point of the space on the line from the origin of R^3 through p: k (x^2 + y^2) + z^2 = 1 there.
template <typename Real>
Vector3Of<Real> precise_retract(Space space, const Vector3Of<Real>& p) {
  using std::sqrt;
  const int k = space.curvature();
  if (k == 0) return p / p.z();
  return p / Real(sqrt(Real(k * (p.x() * p.x() + p.y() * p.y()) + p.z() * p.z())));
}

/// In the line m . p = 0: 1 - 2 m# m^T/(m . m#), with m# = J m.
template <typename Real>
Matrix3Of<Real> precise_reflection(Space space, const Vector3Of<Real>& line) {
  const Vector3Of<Real> raised = precise_raised(space, line);
  const Real scale = Real(2) / line.dot(raised);
  return Matrix3Of<Real>::Identity() - scale * (raised * line.transpose());
}

/// Counterclockwise about a point: see Space::rotation.
template <typename Real>
Matrix3Of<Real> precise_rotation(Space space, const Vector3Of<Real>& point, const Real& angle) {
  using std::cos, std::sin;
  const int k = space.curvature();
  const Real cosine = cos(angle), sine = sin(angle);
  const Vector3Of<Real> n(k * point.x(), k * point.y(), point.z());
  Matrix3Of<Real> turn;
  turn << Real(0), -point.z(), point.y(), point.z(), Real(0), -point.x(), -k * point.y(), k * point.x(),
      Real(0);
  Matrix3Of<Real> result =
      cosine * Matrix3Of<Real>::Identity() + (Real(1) - cosine) * (point * n.transpose()) + sine * turn;
  if (k == 0) result(2, 2) = Real(1);
  return result;
}

/// See Space::isometry.
template <typename Real>
Matrix3Of<Real> precise_inverse(Space space, const Matrix3Of<Real>& isometry) {
  const int k = space.curvature();
  Matrix3Of<Real> result = isometry.transpose();
  if (k == 0) {
    const Eigen::Matrix<Real, 2, 1> back =
        isometry.template topLeftCorner<2, 2>().transpose() * isometry.template topRightCorner<2, 1>();
    result.template topRightCorner<2, 1>() = -back;
    result.template bottomLeftCorner<1, 2>().setZero();
    return result;
  }
  for (int i = 0; i < 2; ++i) {
    result(i, 2) *= Real(k);
    result(2, i) *= Real(k);
  }
  return result;
}

/// The point near `near` that a rotation leaves where it is: no other vector p has (M - 1) p = 0, up to
/// multiples, so that it is the product of two rows of M - 1 that are not parallel.
template <typename Real>
Vector3Of<Real> precise_fixed_point(Space space, const Matrix3Of<Real>& rotation, const Vector3& near) {
  const Matrix3Of<Real> rest = rotation - Matrix3Of<Real>::Identity();
  Vector3Of<Real> best = Vector3Of<Real>::Zero();
  for (int i = 0; i < 3; ++i) {
    const Vector3Of<Real> a = rest.row(i).transpose(), b = rest.row((i + 1) % 3).transpose();
    const Vector3Of<Real> normal = a.cross(b);
    if (normal.squaredNorm() > best.squaredNorm()) best = normal;
  }
  if (best.template cast<double>().dot(near) < 0) best = -best;
  return precise_retract(space, best);
}

}  // namespace orbitutte
