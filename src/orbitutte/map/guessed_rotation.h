// SPDX-License-Identifier: MIT
// The rotation between two maps to the whole sphere if no points are known to correspond.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// A surface and its map to the whole sphere.
struct WholeSphereMap {
  const Surface& surface;
  const Embedding& embedding;
};

/// The rotation R for which the scale of one map at x is most like that of the other at R x: it maximises the
/// correlation, over the sphere, of the logarithms of how much of each surface's area lies around a point
/// there, blurred. First all rotations are tried on a grid, then the best are refined as the blur lessens.
/// From the canonical frame of `from` to that of `to`.
Isometry guessed_rotation(const WholeSphereMap& from, const WholeSphereMap& to);

}  // namespace orbitutte
