// SPDX-License-Identifier: MIT
// W. Kabsch, "A solution for the best rotation to relate two sets of vectors", Acta Crystallographica A32
// (1976).
#pragma once

#include <Eigen/LU>
#include <Eigen/SVD>

#include "orbitutte/types.h"

namespace orbitutte {

struct FittedRotation {
  Matrix3 matrix;

  /// The second singular value of the sum of to_k from_k^T: if it is 0, the points do not say which rotation.
  double certainty = 0;
};

/// The rotation R of R^3 for which the sum of |to_k - R from_k|^2 is least; n x 3 each.
inline FittedRotation fitted_rotation(const Points& from, const Points& to) {
  const Matrix3 product = to.transpose() * from;
  const Eigen::JacobiSVD<Matrix3> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Matrix3 &U = svd.matrixU(), &V = svd.matrixV();
  const double handedness = (U * V.transpose()).determinant() < 0 ? -1 : 1;
  return {U * Vector3(1, 1, handedness).asDiagonal() * V.transpose(), svd.singularValues()[1]};
}

}  // namespace orbitutte
