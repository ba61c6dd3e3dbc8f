// SPDX-License-Identifier: MIT
// Checks that a mesh is what a tiling of the sphere must be.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// Throws MeshError, naming what is wrong, unless the faces are one closed surface: every edge lies between
/// two faces that run along it in opposite directions, the faces around every vertex are one fan, all faces
/// are connected, the Euler characteristic is 2, and every vertex is in some face.
void require_closed_sphere(const Mesh& mesh);
void require_closed_sphere(const Points& V, const Polygons& polygons);

}  // namespace orbitutte
