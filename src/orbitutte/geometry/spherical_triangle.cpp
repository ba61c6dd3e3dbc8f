// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/spherical_triangle.h"

#include <Eigen/Geometry>
#include <cmath>

namespace orbitutte {

double arc_length(const Vector3& p, const Vector3& q) {
  return 2 * std::atan2((p - q).norm(), (p + q).norm());
}

double signed_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  // det[a b c] = a . ((b - a) x (c - a)) keeps the digits of small triangles.
  const double determinant = a.dot((b - a).cross(c - a));
  return 2 * std::atan2(determinant, 1 + a.dot(b) + b.dot(c) + c.dot(a));
}

double angle_at(const Vector3& p, const Vector3& q, const Vector3& r) {
  const Vector3 u = (q - p) - p * p.dot(q - p), v = (r - p) - p * p.dot(r - p);
  return std::atan2(p.dot(u.cross(v)), u.dot(v));
}

}  // namespace orbitutte
