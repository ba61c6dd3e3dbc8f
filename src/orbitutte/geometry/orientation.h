// SPDX-License-Identifier: MIT
// The side of a plane through the origin, exact in sign.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// The sign (-1, 0, 1) of det[a b c] of the vectors exactly as stored: a floating-point filter, and whole
/// numbers of any length where it cannot tell. Positive: the spherical triangle a, b, c is counterclockwise
/// from outside. The entries must be finite.
int orientation_sign(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace orbitutte
