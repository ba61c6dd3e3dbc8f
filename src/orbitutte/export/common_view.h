// SPDX-License-Identifier: MIT
// Two surfaces that correspond, seen from where they look alike.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// The rotation R for which R a is nearest to b, up to their places and sizes (Kabsch 1976); a and b: k x 3,
/// rows that correspond.
Matrix3 best_turn(const Points& a, const Points& b);

/// The same for pictures: the identity if that is a turn of less than half a radian, since surfaces that
/// stand alike should not be tilted against each other.
Matrix3 turn_of_views(const Points& a, const Points& b);

}  // namespace orbitutte
