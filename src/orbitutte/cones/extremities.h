// SPDX-License-Identifier: MIT
// Marked vertices without a user: well separated extremities of the surface.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// Which vertices are to be marked.
struct WantedExtremities {
  /// So many inside the surface,
  int inner = 0;
  /// and so many on its boundary.
  int outer = 0;
  /// No edge joins two of them, if the mesh has such vertices.
  bool no_neighbours = false;
};

/// The inner vertices, then the outer ones: each the farthest from those before, along the edges; the first,
/// from the boundary where it lies inside of one, otherwise from a vertex anywhere. The outer ones stand in
/// an order in which the boundary meets them. O((inner + outer) n log n). Throws MeshError if the mesh has
/// fewer such vertices.
std::vector<int> choose_extremities(const Surface& surface, const WantedExtremities& wanted);

}  // namespace orbitutte
