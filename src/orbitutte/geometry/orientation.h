// SPDX-License-Identifier: MIT
// The side of a plane through the origin, exact in sign.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// The sign (-1, 0, 1) of det[a b c] of the vectors exactly as stored: floating-point filters, and whole
/// numbers of any length where they cannot tell. Positive: the spherical triangle a, b, c is counterclockwise
/// from outside. The entries must be finite.
int orientation_sign(const Vector3& a, const Vector3& b, const Vector3& c);

/// Is the triangle positive as stored, and does whoever measures it in doubles see that? Its sign is exact,
/// but a triangle that is flatter than the rounding of its edges' cross product has angles of any sign in
/// doubles.
bool is_visibly_positive(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace orbitutte
