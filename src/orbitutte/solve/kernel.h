// SPDX-License-Identifier: MIT
// The point of a star's kernel that leaves every triangle the most room.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace orbitutte {

/// value + gradient . step >= margin * weight: a triangle is positively oriented, with a margin in units of
/// `weight`, which is positive.
struct KernelCondition {
  Eigen::Vector2d gradient;
  double value = 0, weight = 1;

  double margin(const Eigen::Vector2d& step) const { return (value + gradient.dot(step)) / weight; }
};

/// A step in the tangent plane, and the least margin behind it.
struct KernelStep {
  Eigen::Vector2d step = Eigen::Vector2d::Zero();
  double margin = 0;
};

/// The step of at most `reach` in each coordinate that has the largest least margin: a linear program in
/// three unknowns. At least one condition is needed.
KernelStep widest_step(const std::vector<KernelCondition>& conditions, const Eigen::Vector2d& reach);

}  // namespace orbitutte
