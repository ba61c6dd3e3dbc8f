// SPDX-License-Identifier: MIT
// The cone angles of least distortion, by least squares: the angles of a target are free, the places of its
// cones are given.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/cones/cone_wishes.h"
#include "orbitutte/cones/scale_kernel.h"

namespace orbitutte {

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

/// The angles at given cones: those of least sigma, but for cones that would take too much of the target
/// (FitOptions::greatest_share). Throws MeshError if a cone is no vertex of a face or is given twice, and if
/// no angles within the bounds have the area.
FittedAngles fit_angles(const ScaleKernel& kernel, const std::vector<int>& cones,
                        const FitOptions& options = {});

/// Throws the MeshError of bounds that cannot be met by so many cones.
[[noreturn]] void refuse_bounds(const CurvatureBounds& bounds);

}  // namespace orbitutte
