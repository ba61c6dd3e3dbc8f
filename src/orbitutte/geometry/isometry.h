// SPDX-License-Identifier: MIT
// Isometries of the three geometries.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// A linear map of R^3 that takes a space to itself and keeps its distances, together with its inverse: what
/// the inverse is depends on the space (Space::isometry), and nobody has to know it later.
class Isometry {
 public:
  /// The identity, of every space.
  Isometry() : matrix_(Matrix3::Identity()), inverse_(Matrix3::Identity()) {}

  /// `inverse` must be the inverse of `matrix`. Space::isometry finds it.
  Isometry(const Matrix3& matrix, const Matrix3& inverse) : matrix_(matrix), inverse_(inverse) {}

  const Matrix3& matrix() const { return matrix_; }

  Isometry inverse() const { return {inverse_, matrix_}; }

  /// The inverse's matrix, without a copy.
  const Matrix3& inverse_matrix() const { return inverse_; }

  Isometry operator*(const Isometry& first) const {
    return {matrix_ * first.matrix_, first.inverse_ * inverse_};
  }

  /// The image of a point, or of a tangent vector.
  Vector3 operator*(const Vector3& point) const { return matrix_ * point; }

  /// The images of points, one a row.
  Points on_rows(const Points& points) const { return points * matrix_.transpose(); }

  /// Does it exchange left and right?
  bool reverses_orientation() const { return matrix_.determinant() < 0; }

  /// The largest difference between the entries of both matrices.
  double difference(const Isometry& other) const { return (matrix_ - other.matrix_).cwiseAbs().maxCoeff(); }

  bool is_identity() const { return matrix_ == Matrix3::Identity(); }

 private:
  Matrix3 matrix_, inverse_;
};

}  // namespace orbitutte
