// SPDX-License-Identifier: MIT
// The cone angles of least distortion, by least squares: the angles of a target are free, the places of its
// cones are given.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/cones/scale_kernel.h"

namespace orbitutte {

/// What is asked of the angles.
struct FitOptions {
  /// The area of the target times its curvature, by Gauss and Bonnet: above 0 it is spherical, below 0
  /// hyperbolic, 0 flat. If not given, the area is fitted, too.
  std::optional<double> area = 0;

  /// Shares of the angle that a vertex has where it is no cone (2 pi inside, pi on the boundary). If the
  /// greatest is not given, it is 2 for flat targets and 0.99 for others, whose angles stay below 2 pi.
  double least_angle = 0.05;
  std::optional<double> greatest_angle = {};

  double greatest() const { return greatest_angle.value_or(area && *area == 0 ? 2 : 0.99); }
};

/// The angles of cones, in their order, and what they are expected to cost.
struct FittedAngles {
  /// Radians.
  std::vector<double> angles;

  /// Curvature times area of the target.
  double area = 0;

  /// Of the logarithm of the scale, by the Laplacian: exact up to the mesh for flat targets, and for curved
  /// ones to first order in their curvature.
  double sigma = 0;
};

/// All that the fit needs to know of some vertices: x are their curvatures, and
///     sigma^2 = variance - 2 pull . x + x . gram x.
struct CurvatureFit {
  Eigen::MatrixXd gram;
  Eigen::VectorXd pull;
  double variance = 0;

  double sigma(const Eigen::VectorXd& x) const;
};

/// Bounds on curvatures, and their sum where that is given.
struct CurvatureBounds {
  Eigen::VectorXd least, greatest;
  std::optional<double> sum;

  bool can_be_met() const;
};

/// The curvatures of least sigma within the bounds, which can be met: a primal active-set method (J. Nocedal,
/// S. J. Wright, "Numerical Optimization", algorithm 16.3).
Eigen::VectorXd least_sigma(const CurvatureFit& fit, const CurvatureBounds& bounds);

/// The bounds of some vertices.
CurvatureBounds bounds_of(const ScaleKernel& kernel, const std::vector<int>& vertices,
                          const FitOptions& options);

/// The angles at given cones. Throws MeshError if a cone is no vertex of a face or is given twice, and if no
/// angles within the bounds have the area.
FittedAngles fit_angles(const ScaleKernel& kernel, const std::vector<int>& cones,
                        const FitOptions& options = {});

/// Throws the MeshError of bounds that cannot be met by so many cones.
[[noreturn]] void refuse_bounds(const CurvatureBounds& bounds);

}  // namespace orbitutte
