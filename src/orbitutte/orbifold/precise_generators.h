// SPDX-License-Identifier: MIT
// The gluings of cone surfaces with more digits than doubles have. In the hyperbolic plane the rounding of
// one factor of a product grows by the size of those that follow.
#pragma once

#include <vector>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/orbifold/mark_order.h"

namespace orbitutte {

/// The rotation about a cone, by its angle; the identity for a corner. position: a point of the space up to
/// rounding.
Matrix3Of<Precise> precise_rotation_about(Space space, const Mark& mark, const Vector3& position);

/// The rotations about all cones; the identity in place of corners. positions: k x 3.
std::vector<Matrix3Of<Precise>> precise_rotations(Space space, const MarkOrder& marks,
                                                  const Points& positions);

/// The generators g_1 .. g_k of Moduli.
std::vector<Matrix3Of<Precise>> precise_generators(Space space, const MarkOrder& marks,
                                                   const Points& positions);

/// The product of all, the first one on the left.
Matrix3Of<Precise> precise_product(const std::vector<Matrix3Of<Precise>>& factors);

/// The isometry of doubles nearest to one of more digits.
Isometry rounded_isometry(Space space, const Matrix3Of<Precise>& precise);

}  // namespace orbitutte
