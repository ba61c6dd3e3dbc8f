// SPDX-License-Identifier: MIT
// A step of a trust-region method in a few unknowns, by the eigenvalues of the Hessian (J. Nocedal, S. J.
// Wright, "Numerical Optimization", chapter 4.3).
#pragma once

#include <Eigen/Core>

namespace orbitutte {

/// gradient . d + d . hessian d/2: what a function changes by, up to third order, where it moves by d.
struct QuadraticModel {
  Eigen::VectorXd gradient;

  /// Symmetric; it may be indefinite.
  Eigen::MatrixXd hessian;

  double operator()(const Eigen::VectorXd& d) const { return gradient.dot(d) + 0.5 * d.dot(hessian * d); }
};

/// The minimum of the model over |d| <= radius, up to rounding. Where the gradient vanishes along a direction
/// of negative curvature, the step stays at zero there.
Eigen::VectorXd trust_region_step(const QuadraticModel& model, double radius);

}  // namespace orbitutte
