// SPDX-License-Identifier: MIT
#include "orbitutte/render/default_view.h"

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "orbitutte/render/render.h"

namespace orbitutte {
namespace {

// Which end of an axis is up.
enum class Upwards { forward, backward };

// The box of the lowest slice along an axis, a thirtieth of the height, as a share of the whole footprint's.
double base_share(Points V, int axis, Upwards upwards) {
  if (upwards == Upwards::backward) V.col(axis) *= -1;
  const Vector3 low = V.colwise().minCoeff(), high = V.colwise().maxCoeff();
  const double level = low[axis] + (high[axis] - low[axis]) / 30;
  Vector3 base_low = high, base_high = low;
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    if (V(v, axis) > level) continue;
    base_low = base_low.cwiseMin(V.row(v).transpose());
    base_high = base_high.cwiseMax(V.row(v).transpose());
  }
  double share = 1;
  for (int k = 0; k < 3; ++k)
    if (k != axis && high[k] > low[k]) share *= (base_high[k] - base_low[k]) / (high[k] - low[k]);
  return share;
}

// The integral of the unit normal over the surface, and its area: closed surfaces have an integral of zero.
struct Orientation {
  Vector3 integral = Vector3::Zero();
  double area = 0;
};

Orientation orientation(const Points& V, const Triangles& F) {
  Orientation result;
  for (Eigen::Index f = 0; f < F.rows(); ++f) {
    const Vector3 a = V.row(F(f, 0)), b = V.row(F(f, 1)), c = V.row(F(f, 2));
    const Vector3 normal = 0.5 * (b - a).cross(c - a);
    result.integral += normal;
    result.area += normal.norm();
  }
  return result;
}

bool is_open(const Orientation& orientation) { return orientation.integral.norm() > 0.25 * orientation.area; }

// The area that would be seen if no part hid another, as a share of the whole.
double projected_share(const SourceFigure& figure, const Vector3& viewer) {
  const Points& V = figure.positions();
  double seen = 0, area = 0;
  for (Eigen::Index f = 0; f < figure.faces().rows(); ++f) {
    const auto F = figure.faces().row(f);
    const Vector3 a = V.row(F[0]), b = V.row(F[1]), c = V.row(F[2]);
    const Vector3 normal = 0.5 * (b - a).cross(c - a);
    seen += std::abs(normal.dot(viewer));
    area += normal.norm();
  }
  return area > 0 ? seen / area : 0;
}

// Twelve directions around the figure, a little from above.
std::vector<Vector3> directions_around(const Vector3& up) {
  const Matrix3 axes = front_axes(up);
  std::vector<Vector3> directions;
  for (int k = 0; k < 12; ++k) {
    const double azimuth = k * std::numbers::pi / 6;
    const Vector3 level = std::cos(azimuth) * axes.row(2) + std::sin(azimuth) * axes.row(0);
    directions.push_back((level + 0.2 * up).normalized());
  }
  return directions;
}

// A flat face seen straight on shows no depth.
Vector3 a_little_aside(const View& view) {
  const Matrix3 axes = view_axes(view);
  return (axes.row(2) + 0.3 * axes.row(0) + 0.2 * axes.row(1)).normalized();
}

// Marked vertices that are seen, how much of the surface faces the viewer, and how near the view is to the
// front: weights by which heads show their faces and animals their flanks.
double score(const SourceFigure& figure, const Points& marked, const View& view) {
  const Vector3& viewer = view.viewer;
  double visible = 0;
  for (Eigen::Index i = 0; i < marked.rows(); ++i)
    visible += figure.is_visible(marked.row(i), viewer, 0.02) ? 1.0 / static_cast<double>(marked.rows()) : 0;
  return 0.5 * visible + 2 * projected_share(figure, viewer) + 0.45 * front_axes(view.up).row(2).dot(viewer);
}

}  // namespace

Vector3 default_up_direction(const Surface& surface) {
  // An open surface does not stand on its rim but faces the viewer.
  if (surface.triangles.rows() == 0 || is_open(orientation(surface.V, surface.triangles)))
    return Vector3::UnitY();
  constexpr double clear = 4;
  const double across_y = base_share(surface.V, 1, Upwards::forward),
               across_z = base_share(surface.V, 2, Upwards::forward);
  if (across_z > 0.6 && across_z > 2 * across_y) return Vector3::UnitZ();
  if (base_share(surface.V, 1, Upwards::backward) > clear * across_y) return -Vector3::UnitY();
  return Vector3::UnitY();
}

View default_view(const SourceFigure& figure, const Points& marked, const Vector3& up) {
  const Orientation facing = orientation(figure.positions(), figure.faces());
  if (is_open(facing)) return {a_little_aside({facing.integral, up}), up};
  View best = {Vector3::UnitZ(), up};
  double best_score = -1;
  for (const Vector3& viewer : directions_around(up)) {
    const double s = score(figure, marked, {viewer, up});
    if (s > best_score + 1e-6) best_score = s, best.viewer = viewer;
  }
  return best;
}

}  // namespace orbitutte
