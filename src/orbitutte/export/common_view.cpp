// SPDX-License-Identifier: MIT
// W. Kabsch, "A solution for the best rotation to relate two sets of vectors", Acta Crystallographica A32
// (1976).
#include "orbitutte/export/common_view.h"

#include <Eigen/LU>
#include <Eigen/SVD>
#include <cmath>

namespace orbitutte {

Matrix3 best_turn(const Points& a, const Points& b) {
  const Points from = a.rowwise() - a.colwise().mean(), to = b.rowwise() - b.colwise().mean();
  const Matrix3 product = to.transpose() * from;
  const Eigen::JacobiSVD<Matrix3> svd(product, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Matrix3 sign = Matrix3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * sign * svd.matrixV().transpose();
}

Matrix3 turn_of_views(const Points& a, const Points& b) {
  const Matrix3 turn = best_turn(a, b);
  const double cosine = (turn.trace() - 1) / 2;
  return cosine > std::cos(0.5) ? Matrix3(Matrix3::Identity()) : turn;
}

}  // namespace orbitutte
