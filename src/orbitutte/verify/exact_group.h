// SPDX-License-Identifier: MIT
// The group by which exact positions are compared. Private to verify/.
#pragma once

#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/orbifold/seam_group.h"

namespace orbitutte {

/// That of the target which the signature names, in its canonical frame, or, if its tile is free, in the
/// frame where the marks lie. The seams have to glue the boundary (see certify). Throws ArgumentError if the
/// embedding has no such boundary, or the signature names no target.
PreciseGroup<MostPrecise> exact_group(const Embedding& embedding, const ExactPositions& positions);

}  // namespace orbitutte
