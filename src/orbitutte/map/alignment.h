// SPDX-License-Identifier: MIT
// The rotation that must be chosen before two embeddings into one target can be compared.
#pragma once

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The rotation about (0, 0, 1) that takes the points `from` best to the points `to`, modulo the group of
/// the target. Both are k x 3, in the canonical frame; rows are images of corresponding points. The group
/// has n rotations about that axis. The angle a maximises the sum of w cos(n (a + longitude(from) -
/// longitude(to))), where w is the product of both distances from the axis and, if the group exchanges above
/// and below, of both heights. The identity for targets that leave no rotation free
/// (Target::is_free_to_rotate). Onto the whole sphere, which may be turned about any axis, it is the rotation
/// R that maximises the sum of <to, R from>. Throws ArgumentError if the numbers of rows differ, or if the
/// points say too little: all of them lie on the axis, or on one line through the centre of the whole sphere.
Isometry best_rotation(const Target& target, const Points& from, const Points& to);

}  // namespace orbitutte
