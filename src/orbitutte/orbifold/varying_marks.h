// SPDX-License-Identifier: MIT
// How the generators of a cone surface's gluings, and what has to vanish for it to close, change where its
// marks move (W. M. Goldman, "The symplectic nature of fundamental groups of surfaces", Advances in
// Mathematics 54 (1984)).
#pragma once

#include <vector>

#include "orbitutte/orbifold/mark_order.h"
#include "orbitutte/orbifold/varying_isometry.h"

namespace orbitutte {

/// Marks that move along geodesics: by the step directions * t, in the coordinates of Moduli.
class VaryingMarks {
 public:
  /// positions: k x 3; directions: 2k x q.
  VaryingMarks(Space space, const MarkOrder& marks, const Points& positions,
               const Eigen::MatrixXd& directions, Order order);

  /// The marks themselves.
  const std::vector<VaryingPoint>& points() const { return points_; }

  /// About the cones; the identity in place of corners.
  const std::vector<VaryingIsometry>& rotations() const { return rotations_; }

  /// Carries the cone in place `moved` by an isometry. From then on it is met in place `other`, and the cone
  /// there in its own. The motion must not be one of rotations(), which change.
  void carry(int moved, int other, const VaryingIsometry& motion);

  /// Moduli::generators.
  std::vector<VaryingIsometry> generators() const;

  /// The derivative of Moduli::closing: a row for each of its numbers, q columns.
  Eigen::MatrixXd closing_rates() const;

  /// The second derivative (q x q) of its product with the multipliers, for marks that close.
  Eigen::MatrixXd closing_curvature(const Eigen::VectorXd& multipliers) const;

 private:
  VaryingIsometry identity() const { return {Isometry(), VaryingMotion::none(space_, parameters_, order_)}; }
  VaryingIsometry mirror(int corner) const;

  /// The next and the last corner, as they are seen from a corner, whose own motion is taken off theirs.
  VaryingPoint next_corner(int corner) const;
  VaryingPoint last_corner(int corner) const;
  VaryingIsometry product_of_rotations() const;
  Eigen::MatrixXd angle_rates() const;

  /// Calls visit(row, next, last) with the bearings of both, for every corner.
  template <typename Visit>
  void for_bearings(const Visit& visit) const;

  Space space_;
  const MarkOrder& marks_;
  Eigen::Index parameters_;
  Order order_;
  std::vector<VaryingPoint> points_;

  /// The identity in place of corners.
  std::vector<VaryingIsometry> rotations_;
};

}  // namespace orbitutte
