// SPDX-License-Identifier: MIT
// The triangulation as thin lines, if triangles are large enough in the picture.
#pragma once

#include "orbitutte/render/ray_scene.h"

namespace orbitutte {

/// The mean length of the faces' sides.
double mean_edge_length(const Points& V, const Triangles& F);

/// How strongly lines are drawn if edges are so many pixels long: 0 below 6, 1 from 16 on.
float line_strength(double edge_pixels);

/// Whether a hit lies on a line of the mesh, 0 or 1. pixel: the length of a pixel's side in the world.
float line_coverage(const Points& V, const Triangles& F, const Hit& hit, double pixel);

}  // namespace orbitutte
