// SPDX-License-Identifier: MIT
#include "orbitutte/map/map_distortion.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace orbitutte {
namespace {

// A triangle laid into the plane: its first corner at (0, 0), its second at (length, 0), its third at (x, y).
struct LaidTriangle {
  LaidTriangle(const Vector3& a, const Vector3& b, const Vector3& c) {
    const Vector3 u = b - a, v = c - a;
    length = u.norm();
    x = length > 0 ? v.dot(u) / length : 0;
    y = length > 0 ? u.cross(v).norm() / length : 0;
  }

  double area() const { return length * y / 2; }

  double length = 0, x = 0, y = 0;
};

LaidTriangle laid(const Triangles& triangles, Eigen::Index t, const Points& at) {
  return {at.row(triangles(t, 0)), at.row(triangles(t, 1)), at.row(triangles(t, 2))};
}

// The sums of s^2 + t^2 and of s t of the linear map from one triangle to another: [a b; 0 d].
struct LinearPart {
  LinearPart(const LaidTriangle& from, const LaidTriangle& to) {
    const double a = to.length / from.length, d = to.y / from.y, b = (to.x - a * from.x) / from.y;
    squares = a * a + b * b + d * d;
    determinant = a * d;
  }

  // `scale`: by what areas are multiplied to compare surfaces of area one.
  double symmetric_dirichlet(double scale) const {
    const double s = squares * scale, d = determinant * scale;
    return (s + s / (d * d)) / 4;
  }

  double squares, determinant;
};

double total_area(const Triangles& triangles, const Points& at) {
  double sum = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) sum += laid(triangles, t, at).area();
  return sum;
}

// The value that a share of the weight does not exceed; pairs of values and weights, sorted.
double quantile(const std::vector<std::pair<double, double>>& sorted, double share) {
  double all = 0, below = 0;
  for (const auto& [value, weight] : sorted) all += weight;
  for (const auto& [value, weight] : sorted)
    if ((below += weight) >= share * all) return value;
  return sorted.empty() ? 0 : sorted.back().first;
}

}  // namespace

MapDistortion measure_map(const Triangles& triangles, const Points& from, const Points& to) {
  const double area_from = total_area(triangles, from), area_to = total_area(triangles, to);
  const double scale = area_from / area_to;
  MapDistortion result;
  std::vector<std::pair<double, double>> energies;
  double measured = 0, sum = 0;
  for (Eigen::Index t = 0; t < triangles.rows(); ++t) {
    const LaidTriangle a = laid(triangles, t, from), b = laid(triangles, t, to);
    const double share = a.area() / area_from;
    const LinearPart map(a, b);
    const double energy = map.symmetric_dirichlet(scale);
    if (!std::isfinite(energy)) {
      result.degenerate += share;
      continue;
    }
    energies.emplace_back(energy, share);
    measured += share;
    sum += share * energy;
    if (std::abs(std::log(map.determinant * scale)) <= std::log(4.0)) result.within_4 += share;
  }
  result.within_4 = std::min(result.within_4, 1.0);  // shares add up to 1 but for rounding
  std::sort(energies.begin(), energies.end());
  result.symmetric_dirichlet.mean = measured > 0 ? sum / measured : 0;
  result.symmetric_dirichlet.median = quantile(energies, 0.5);
  result.symmetric_dirichlet.percentile_90 = quantile(energies, 0.9);
  return result;
}

}  // namespace orbitutte
