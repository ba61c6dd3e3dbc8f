// SPDX-License-Identifier: MIT
// Finer meshes of the same surface.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// Divides every triangle of an edge-manifold mesh into four at the midpoints of its edges. The vertices keep
/// their numbers. Triangle f becomes the triangles 4 f + k at its corners k, which begin with the corner that
/// they share with it, and 4 f + 3 in the middle.
Mesh subdivided(const Mesh& mesh);

}  // namespace orbitutte
