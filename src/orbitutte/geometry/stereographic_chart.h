// SPDX-License-Identifier: MIT
// A space seen from the point opposite to a centre: a conformal picture of it in the plane.
#pragma once

#include <algorithm>

#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// The points of the plane are vectors (x, y, 0). With the centre at (0, 0, 1), p is (p_x, p_y)/(1 + p_z).
class StereographicChart {
 public:
  StereographicChart(Space space, const Vector3& centre)
      : k_(space.curvature()), to_origin_(space.to_origin(centre)), from_origin_(to_origin_.inverse()) {}

  /// The picture of a point of the space.
  Vector3 flat(const Vector3& point) const {
    const Vector3 p = to_origin_ * point;
    return Vector3(p.x(), p.y(), 0) / std::max(1 + p.z(), 1e-3);
  }

  /// The point of the space whose picture this is: (2 x, 2 y, 1 - k s)/(1 + k s) with s = x^2 + y^2.
  Vector3 point(const Vector3& flat) const {
    const double s = k_ * flat.squaredNorm();
    return from_origin_ * Vector3(Vector3(2 * flat.x(), 2 * flat.y(), 1 - s) / (1 + s));
  }

  /// The tangent vector of the space whose picture is a vector at that point of the plane.
  Vector3 tangent(const Vector3& flat, const Vector3& vector) const {
    const double a = 1 + k_ * flat.squaredNorm(), change = 2 * k_ * flat.dot(vector);  // of a
    const Vector3 along = 2 / a * vector - 2 * change / (a * a) * flat;
    return from_origin_ * Vector3(along.x(), along.y(), -2 * change / (a * a));
  }

 private:
  double k_;
  Isometry to_origin_, from_origin_;
};

}  // namespace orbitutte
