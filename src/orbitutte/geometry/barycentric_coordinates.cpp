// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/barycentric_coordinates.h"

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

double distance(Space space, const TriangleCorners& corners, const Vector3& coordinates,
                const Vector3& point) {
  return (barycentric_point(space, corners, coordinates) - point).norm();
}

Vector3 clamped(const Vector3& coordinates) {
  const Vector3 positive = coordinates.cwiseMax(0);
  return positive / positive.sum();
}

// Where the perpendicular from the point meets the geodesic from a to b, as the share of b: with the
// geodesic's unit normal m, point = l_a a + l_b b + l_m m, so that l_a : l_b = det[point b m] : det[a point
// m].
double foot_along(Space space, const Vector3& a, const Vector3& b, const Vector3& point) {
  const Vector3 line = a.cross(b - a), m = space.normal(line);
  const double of_a = m.dot(point.cross(b - point)), of_b = m.dot(a.cross(point - a));
  return of_a + of_b > 0 ? std::clamp(of_b / (of_a + of_b), 0.0, 1.0) : 0.0;
}

// What the coordinates are short of: those of the residual by Cramer's rule, which is exact enough as it is
// small.
Vector3 corrected(Space space, const TriangleCorners& corners, const Vector3& coordinates,
                  const Vector3& point) {
  const auto& [a0, a1, a2] = corners;
  const Vector3 x = coordinates[0] * a0 + coordinates[1] * a1 + coordinates[2] * a2;
  // x is nearly a multiple of the point: that of n(p) . x, with n(p) . p = 1.
  const double length = visit_curvature(space, [&](auto c) { return c.off_tangent(point, x); });
  const Vector3 residual = length * point - x;
  const Vector3 correction(residual.dot(a1.cross(a2)), residual.dot(a2.cross(a0)),
                           residual.dot(a0.cross(a1)));
  const Vector3 sum = coordinates + correction / near_determinant(a0, a1, a2);
  return sum / sum.sum();
}

}  // namespace

Vector3 barycentric_point(Space space, const TriangleCorners& corners, const Vector3& coordinates) {
  return space.retract(coordinates[0] * corners[0] + coordinates[1] * corners[1] +
                       coordinates[2] * corners[2]);
}

bool triangle_contains(const TriangleCorners& corners, const Vector3& point) {
  for (int k = 0; k < 3; ++k)
    if (side(point, corners[k], corners[(k + 1) % 3]) < 0) return false;
  return true;
}

Vector3 barycentric_coordinates(Space space, const TriangleCorners& corners, const Vector3& point) {
  constexpr double rounding = 4e-16, lost = 1e-14;
  const auto& [a, b, c] = corners;
  const Vector3 determinants(near_determinant(point, b, c), near_determinant(point, c, a),
                             near_determinant(point, a, b));
  Vector3 best = clamped(determinants);
  double error = distance(space, corners, best, point);
  for (int k = 0; k < 2 && error > rounding; ++k) {  // in thin triangles
    const Vector3 next = clamped(corrected(space, corners, best, point));
    const double remaining = distance(space, corners, next, point);
    if (!(remaining < error)) break;
    best = next;
    error = remaining;
  }
  if (error <= lost) return best;
  const Vector3 on_edge =
      nearest_on_edges(space, corners, point);  // in one so thin that only its edges have digits
  return distance(space, corners, on_edge, point) < error || !(error >= 0) ? on_edge : best;
}

Vector3 nearest_on_edges(Space space, const TriangleCorners& corners, const Vector3& point) {
  Vector3 nearest = Vector3::Zero();
  double least = std::numeric_limits<double>::infinity();
  for (int k = 0; k < 3; ++k) {
    const double t = foot_along(space, corners[k], corners[(k + 1) % 3], point);
    Vector3 coordinates = Vector3::Zero();
    coordinates[k] = 1 - t;
    coordinates[(k + 1) % 3] = t;
    const double away = distance(space, corners, coordinates, point);
    if (away < least) {
      least = away;
      nearest = coordinates;
    }
  }
  return nearest;
}

// With the squared chords c_ij, sum l_i a_i is sqrt(1 - k sum l_i l_j c_ij) times a point of the space, and
// the sum of l_i l_j over the pairs is 1/3 at most.
double triangle_bulge(Space space, const TriangleCorners& corners) {
  double squared_chord = 0, length = 0;
  for (int k = 0; k < 3; ++k) {
    const Vector3 chord = corners[k] - corners[(k + 1) % 3];
    squared_chord = std::max(squared_chord, space.dot(chord, chord));
    length = std::max(length, corners[k].norm());
  }
  const double factor = std::sqrt(std::max(0.0, 1 - space.curvature() * squared_chord / 3));
  return length * std::abs(1 - factor);
}

}  // namespace orbitutte
