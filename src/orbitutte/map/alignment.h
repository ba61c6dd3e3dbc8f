// SPDX-License-Identifier: MIT
// What is left to choose before two embeddings into one target can be compared.
#pragma once

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The rotation about (0, 0, 1) that takes the points `from` best to the points `to` (k x 3 each, in the
/// canonical frame, row by row images of corresponding points), modulo the group of the target. The group has
/// n rotations about that axis; the angle a maximises the sum of w cos(n (a + longitude(from) -
/// longitude(to))), where w is the product of both distances from the axis, and of both heights where the
/// group exchanges above and below. The identity for targets that leave no rotation free
/// (Target::is_free_to_rotate). Throws ArgumentError if the numbers of rows differ, or if no row says
/// anything: all points lie on the axis.
Isometry best_rotation(const Target& target, const Points& from, const Points& to);

}  // namespace orbitutte
