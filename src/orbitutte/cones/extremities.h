// SPDX-License-Identifier: MIT
// Marked vertices without a user: well separated extremities of the surface.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// `inner` vertices inside the surface, then `outer` ones on its boundary: each the farthest from those
/// before, along the edges; the first, from the boundary where it lies inside of one, otherwise from a vertex
/// anywhere. O((inner + outer) n log n). Throws MeshError where the mesh has fewer such vertices.
std::vector<int> extremities(const Surface& surface, int inner, int outer);

}  // namespace orbitutte
