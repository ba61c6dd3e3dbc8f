// SPDX-License-Identifier: MIT
// Faces that came out turned over, put right by moving single vertices.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/solve/local_minimum.h"
#include "orbitutte/solve/stars.h"

namespace orbitutte {

/// Where faces are repaired.
struct RepairSite {
  const Surface& surface;
  const Gluing& gluing;
  const Stars& stars;

  /// n: may the vertex be moved?
  const std::vector<char>& may_move;
};

/// Thin triangles of the input that are no faces of the triangulation that has the weights may come out
/// turned over. Their vertices are moved into the kernels of their stars, sweep by sweep, and the vertices
/// around are smoothed. So are those of triangles that are flat up to rounding, be their signs as they may:
/// up to what rounding does to positions, the map does not depend on how the surface was cut. Returns the
/// vertices that moved, ascending, if all faces are positive then; otherwise every vertex is where it was,
/// and nothing is returned.
std::vector<int> repair(const RepairSite& site, MovablePositions& positions);

}  // namespace orbitutte
