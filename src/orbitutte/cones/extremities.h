// SPDX-License-Identifier: MIT
// Marked vertices without a user: well separated extremities of the surface.
#pragma once

#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// Which vertices are to be marked.
struct WantedExtremities {
  int inner = 0;               ///< so many inside the surface,
  int outer = 0;               ///< and so many on its boundary
  bool no_neighbours = false;  ///< no edge joins two of them, if the mesh has such vertices
};

/// The inner vertices, then the outer ones: each the farthest from those before, along the edges; the first,
/// from the boundary where it lies inside of one, otherwise from a vertex anywhere. O((inner + outer) n log
/// n). Throws MeshError if the mesh has fewer such vertices.
std::vector<int> extremities(const Mesh& mesh, const Connectivity& connectivity,
                             const WantedExtremities& wanted);

}  // namespace orbitutte
