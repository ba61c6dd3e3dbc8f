// SPDX-License-Identifier: MIT
// By cutting planes: the program of a few conditions is solved by trying all triples of them, and the
// condition that the solution breaks most joins them. Stars have some six triangles; hubs with thousands need
// few more.
#include "orbitutte/solve/kernel.h"

#include <Eigen/LU>
#include <algorithm>
#include <limits>

namespace orbitutte {
namespace {

// row . (step, margin) >= bound.
struct HalfSpace {
  Eigen::Vector3d row;
  double bound;

  double slack(const Eigen::Vector3d& x) const { return row.dot(x) - bound; }
};

constexpr double slack_rounding = 1e-12;

HalfSpace half_space(const KernelCondition& condition) {
  return {{condition.gradient.x(), condition.gradient.y(), -condition.weight}, -condition.value};
}

// The point with the largest margin where three planes meet and no other condition is broken.
Eigen::Vector3d best_corner(const std::vector<HalfSpace>& conditions) {
  Eigen::Vector3d best(0, 0, -std::numeric_limits<double>::infinity());
  const std::size_t count = conditions.size();
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      for (std::size_t k = j + 1; k < count; ++k) {
        Eigen::Matrix3d A;
        A << conditions[i].row.transpose(), conditions[j].row.transpose(), conditions[k].row.transpose();
        const double determinant = A.determinant();
        if (std::abs(determinant) <=
            slack_rounding * conditions[i].row.norm() * conditions[j].row.norm() * conditions[k].row.norm())
          continue;
        const Eigen::Vector3d x =
            A.inverse() * Eigen::Vector3d(conditions[i].bound, conditions[j].bound, conditions[k].bound);
        if (!(x.z() > best.z())) continue;
        const bool holds = std::all_of(conditions.begin(), conditions.end(), [&](const HalfSpace& other) {
          return other.slack(x) >= -slack_rounding * (other.row.norm() * (1 + x.norm()));
        });
        if (holds) best = x;
      }
    }
  }
  return best;
}

}  // namespace

KernelStep widest_step(const std::vector<KernelCondition>& conditions, const Eigen::Vector2d& reach) {
  std::vector<HalfSpace> tried;
  for (int axis = 0; axis < 2; ++axis)
    for (const double sign : {1.0, -1.0})
      tried.push_back({Eigen::Vector3d(axis == 0 ? sign : 0, axis == 1 ? sign : 0, 0), -reach[axis]});
  KernelStep result;
  std::size_t next = 0;
  for (std::size_t round = 0; round <= conditions.size(); ++round) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < conditions.size(); ++k) {
      const double margin = conditions[k].margin(result.step);
      if (margin >= least) continue;
      least = margin;
      next = k;
    }
    if (round > 0 && least >= result.margin - slack_rounding * (1 + std::abs(result.margin))) break;
    tried.push_back(half_space(conditions[next]));
    const Eigen::Vector3d corner = best_corner(tried);
    if (!std::isfinite(corner.z())) break;
    result = {corner.head<2>(), corner.z()};
  }
  double least = std::numeric_limits<double>::infinity();
  for (const KernelCondition& condition : conditions) least = std::min(least, condition.margin(result.step));
  result.margin = least;
  return result;
}

}  // namespace orbitutte
