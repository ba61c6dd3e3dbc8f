// SPDX-License-Identifier: MIT
#include "orbitutte/geometry/geometry.h"

namespace orbitutte {
namespace {

bool is_affine(const Matrix3& isometry) { return isometry.row(2) == Eigen::RowVector3d(0, 0, 1); }

}  // namespace

Matrix3 inverse_isometry(const Matrix3& isometry) {
  if (!is_affine(isometry)) return isometry.transpose();
  Matrix3 inverse = Matrix3::Identity();
  inverse.topLeftCorner<2, 2>() = isometry.topLeftCorner<2, 2>().transpose();
  inverse.topRightCorner<2, 1>() = -inverse.topLeftCorner<2, 2>() * isometry.topRightCorner<2, 1>();
  return inverse;
}

Matrix3 linear_part(const Matrix3& isometry) {
  Matrix3 result = isometry;
  if (is_affine(isometry)) result.topRightCorner<2, 1>().setZero();
  return result;
}

}  // namespace orbitutte
