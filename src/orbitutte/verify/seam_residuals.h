// SPDX-License-Identifier: MIT
// Do the positions on both banks of the seams match, at the scale of the edges beside them? Private to
// verify/.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/exact_positions.h"

namespace orbitutte {

struct SeamResiduals {
  /// The largest entry of position(left) - transform * position(right).
  double largest = 0;

  /// That of the pair which comes nearest to its bound, or is furthest beyond it, and the bound.
  double value = 0, bound = 0;

  /// Empty if every pair is within its bound; otherwise the worst, or why the seams cannot be judged.
  std::string failure;
};

/// A pair may be off by a thousandth of the shortest edge at its two vertices. A mirror's vertex may be off
/// by a hundredth, since ears are rounded to the outer side of their mirror. Rounding of doubles is always
/// allowed, and more than 1e-12 never is (in units of the position, if that is large). If a position has
/// offsets, exact positions are compared by the exact element of the target's group (exact_group), so the
/// embedding has to lie in the canonical frame, unless its tile is free: then the exact positions of its
/// marks say where it lies. triangles: the embedding, its polygons divided.
SeamResiduals judge_seams(const Embedding& triangles, const ExactPositions& positions);

}  // namespace orbitutte
