// SPDX-License-Identifier: MIT
// The check that a mesh is what a tiling of the sphere has to be.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// Throws MeshError, naming what is wrong, unless the faces are one closed surface: every edge between
/// two faces that run along it in opposite directions, the faces around every vertex one fan, all in one
/// piece, Euler characteristic 2, and every vertex in some face.
void require_closed_sphere(const Mesh& mesh);
void require_closed_sphere(const Points& V, const Polygons& polygons);

}  // namespace orbitutte
