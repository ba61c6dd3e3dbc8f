// SPDX-License-Identifier: MIT
// Marked vertices without a user: well separated extremities of the surface.
#pragma once

#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// `count` vertices of the surface, on its boundary where it has one: each the farthest from those before,
/// along the edges; the first, from a vertex anywhere. O(count n log n). Throws MeshError where the mesh has
/// fewer such vertices.
std::vector<int> extremities(const Mesh& mesh, const Connectivity& connectivity, int count);

}  // namespace orbitutte
