// SPDX-License-Identifier: MIT
// Two surfaces on one tile: the maps whose energies have the least sum, and where they lie.
#pragma once

#include <array>
#include <functional>

#include "orbitutte/solve/curved_map.h"

namespace orbitutte {

/// Two cut surfaces with the same target, whose tile is free. Both cuts meet the marks in the same order,
/// that of the marks.
using ProblemPair = std::array<std::reference_wrapper<const GluingProblem>, 2>;

/// The own conformal tile of each surface, as own_tile has it; in the plane its cones alone. Throws as
/// curved_map does.
std::array<TiledPositions, 2> own_tiles(const ProblemPair& problems, const LbfgsOptions& options,
                                        Stages& stage);

/// How two surfaces share a tile.
struct SharingOptions {
  /// Is it the tile that depends on the target alone, a polygon with an inscribed circle, doubled?
  bool is_tile_regular = false;

  /// Takes the cones of the second surface's own tile to the places in which they correspond to those of the
  /// first.
  Braid braid;

  /// From which the search begins; not used in the plane, nor for a regular tile and an empty braid.
  std::array<TiledPositions, 2> own;
  LbfgsOptions lbfgs;
};

/// The placements of both, their frames such that what lies at the same point in the canonical frame
/// corresponds: the first mark of either lies at (0, 0, 1) there, and the second mark of the first surface in
/// the direction of x. The other marks of the second surface lie where the tile's group has images of those
/// of the first; at the same points if the braid is empty. Throws as curved_map does.
std::array<Placement, 2> place_together(const ProblemPair& problems, const SharingOptions& options,
                                        Stages& stage);

}  // namespace orbitutte
