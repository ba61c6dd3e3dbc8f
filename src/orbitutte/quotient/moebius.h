// SPDX-License-Identifier: MIT
// Möbius maps of the sphere: what a conformal map of a surface to the whole sphere may be followed by.
#pragma once

#include <Eigen/Core>
#include <array>
#include <utility>

#include "orbitutte/cones/chart.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// The chart's point of a unit vector: the inverse of sphere_point.
ChartPoint chart_point_of(const Vector3& unit);

/// A map z -> (a z + b)/(c z + d) of the sphere, as sphere_point lays it.
class Moebius {
 public:
  /// The identity.
  Moebius() : matrix_(Eigen::Matrix2cd::Identity()) {}

  /// Takes three points to three others. The points of each three must be distinct.
  static Moebius through(const std::array<ChartPoint, 3>& from, const std::array<ChartPoint, 3>& to);

  /// Draws all points away from -u and towards u = velocity/|velocity|, which are fixed: a point at the
  /// height h along u comes to (h + tanh t)/(1 + h tanh t), t = |velocity|. Its derivative by the velocity is
  /// the conformal field v -> v - <v, p> p at the identity.
  static Moebius boost(const Vector3& velocity);

  /// The rotation whose matrix this is.
  static Moebius rotation(const Matrix3& rotation);

  Moebius operator*(const Moebius& first) const { return Moebius(matrix_ * first.matrix_); }

  /// Where a point's image lies on the unit sphere, with all of its digits.
  Vector3Of<Precise> precise_image(const ChartPoint& point) const;

  /// Without digits beyond doubles.
  ChartPoint operator()(const ChartPoint& point) const;

 private:
  explicit Moebius(Eigen::Matrix2cd matrix) : matrix_(std::move(matrix)) {}

  Eigen::Matrix2cd matrix_;
};

}  // namespace orbitutte
