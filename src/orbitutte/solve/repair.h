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
/// around are smoothed. Returns the vertices that moved, ascending, if all faces are positive then; otherwise
/// every vertex is where it was, and nothing is returned. turned: the faces that are not positive.
std::vector<int> repair(const RepairSite& site, const std::vector<int>& turned, MovablePositions& positions);

}  // namespace orbitutte
