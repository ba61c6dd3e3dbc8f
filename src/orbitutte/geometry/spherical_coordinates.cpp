// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/spherical_coordinates.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "orbitutte/geometry/orientation.h"

namespace orbitutte {
namespace {

// det[p a b] of three vectors near to each other: differences lose no digits there.
double near_determinant(const Vector3& p, const Vector3& a, const Vector3& b) {
  return p.dot((a - p).cross(b - p));
}

// The sign of det[p a b]. Rounding errors of near_determinant are below 10 units of 1.1e-16 |a - p| |b - p|.
int side(const Vector3& p, const Vector3& a, const Vector3& b) {
  const double determinant = near_determinant(p, a, b);
  const double bound = 4e-15 * (a - p).norm() * (b - p).norm();
  if (std::abs(determinant) > bound) return determinant > 0 ? 1 : -1;
  return orientation_sign(p, a, b);
}

double distance(const SphericalCorners& corners, const Vector3& coordinates, const Vector3& point) {
  return (spherical_point(corners, coordinates) - point).norm();
}

Vector3 clamped(const Vector3& coordinates) {
  const Vector3 positive = coordinates.cwiseMax(0);
  return positive / positive.sum();
}

// What the coordinates are short of: those of the residual by Cramer's rule, which is exact enough as it is
// small.
Vector3 corrected(const SphericalCorners& corners, const Vector3& coordinates, const Vector3& point) {
  const auto& [a, b, c] = corners;
  const Vector3 x = coordinates[0] * a + coordinates[1] * b + coordinates[2] * c;
  const double length = x.norm();
  const Vector3 residual = length * point - x;
  const Vector3 correction(residual.dot(b.cross(c)), residual.dot(c.cross(a)), residual.dot(a.cross(b)));
  const Vector3 sum = coordinates + correction / near_determinant(a, b, c);
  return sum / sum.sum();
}

}  // namespace

Vector3 spherical_point(const SphericalCorners& corners, const Vector3& coordinates) {
  return (coordinates[0] * corners[0] + coordinates[1] * corners[1] + coordinates[2] * corners[2])
      .normalized();
}

bool contains(const SphericalCorners& corners, const Vector3& point) {
  for (int k = 0; k < 3; ++k)
    if (side(point, corners[k], corners[(k + 1) % 3]) < 0) return false;
  return true;
}

Vector3 spherical_coordinates(const SphericalCorners& corners, const Vector3& point) {
  constexpr double rounding = 4e-16, lost = 1e-14;
  const auto& [a, b, c] = corners;
  const Vector3 determinants(near_determinant(point, b, c), near_determinant(point, c, a),
                             near_determinant(point, a, b));
  Vector3 best = clamped(determinants);
  double error = distance(corners, best, point);
  for (int k = 0; k < 2 && error > rounding; ++k) {  // in thin triangles
    const Vector3 next = clamped(corrected(corners, best, point));
    const double remaining = distance(corners, next, point);
    if (!(remaining < error)) break;
    best = next;
    error = remaining;
  }
  if (error <= lost) return best;
  const Vector3 on_edge = nearest_on_edges(corners, point);  // in one so thin that only its edges have digits
  return distance(corners, on_edge, point) < error || !(error >= 0) ? on_edge : best;
}

Vector3 nearest_on_edges(const SphericalCorners& corners, const Vector3& point) {
  Vector3 nearest = Vector3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const Vector3 &from = corners[k], along = corners[(k + 1) % 3] - from;
    const double squared = along.squaredNorm();
    const double t = squared > 0 ? std::clamp((point - from).dot(along) / squared, 0.0, 1.0) : 0.0;
    Vector3 coordinates = Vector3::Zero();
    coordinates[k] = 1 - t;
    coordinates[(k + 1) % 3] = t;
    const double away = distance(corners, coordinates, point);
    if (away < least) {
      least = away;
      nearest = coordinates;
    }
  }
  return nearest;
}

}  // namespace orbitutte
