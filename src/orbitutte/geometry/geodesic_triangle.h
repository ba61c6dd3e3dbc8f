// SPDX-License-Identifier: MIT
// Angles and areas of geodesic triangles from the differences of their corners: they keep their digits where
// the differences do, however small the triangle.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cmath>

#include "orbitutte/geometry/curvature.h"

namespace orbitutte {

/// atan2(y, x). Most triangles are small, and so are their areas: for these by the power series, whose next
/// term is below half a unit in the last place.
inline double angle_of(double y, double x) {
  const double t = y / x, s = t * t;
  if (x > 0 && s < 0x1p-13) return t * (1 - s * (1.0 / 3 - s * (1.0 / 5 - s / 7)));
  return std::atan2(y, x);
}

/// The angle at p from the geodesic to p + u counterclockwise to that to p + v, in (-pi, pi].
template <int k>
double angle_between(Curvature<k> curvature, const Vector3& p, const Vector3& u, const Vector3& v) {
  const Vector3 first = curvature.tangent(p, u), second = curvature.tangent(p, v);
  return std::atan2(p.dot(first.cross(second)), curvature.dot(first, second));
}

/// The signed area of the triangle a, a + u, a + v: see Space::area.
template <int k>
double area_between(Curvature<k> curvature, const Vector3& a, const Vector3& u, const Vector3& v) {
  const double determinant = a.dot(u.cross(v));
  if constexpr (k == 0) return determinant / 2;
  const Vector3 w = v - u;
  return 2 *
         angle_of(2 * determinant, 8 - k * (curvature.dot(u, u) + curvature.dot(w, w) + curvature.dot(v, v)));
}

/// The same of the corners a, b, c: see Space::area.
template <int k>
double area_of(Curvature<k> curvature, const Vector3& a, const Vector3& b, const Vector3& c) {
  const Vector3 ab = b - a, ac = c - a, bc = c - b;
  const double determinant = a.dot(ab.cross(ac));  // of differences: keeps the digits of small triangles
  if constexpr (k == 0) return determinant / 2;
  const double chords = curvature.dot(ab, ab) + curvature.dot(bc, bc) + curvature.dot(ac, ac);
  return 2 * angle_of(2 * determinant, 8 - k * chords);
}

}  // namespace orbitutte
