// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/metric.h"

#include <Eigen/Geometry>
#include <cmath>

#include "orbitutte/geometry/spherical_triangle.h"

namespace orbitutte {
namespace {

double plane_distance(const Vector3& p, const Vector3& q) { return (p - q).norm(); }

double plane_area(const Vector3& a, const Vector3& b, const Vector3& c) {
  return 0.5 * (b - a).cross(c - a).z();
}

double plane_angle(const Vector3& p, const Vector3& q, const Vector3& r) {
  const Vector3 u = q - p, v = r - p;
  return std::atan2(u.cross(v).z(), u.dot(v));
}

}  // namespace

const Metric& metric_of(Geometry geometry) {
  static const Metric sphere = {arc_length, signed_area, angle_at},
                      plane = {plane_distance, plane_area, plane_angle};
  return geometry == Geometry::spherical ? sphere : plane;
}

}  // namespace orbitutte
