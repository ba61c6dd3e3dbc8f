// SPDX-License-Identifier: MIT
// The image on the sphere as a surface of its own, as programs for the cortex take it.
#pragma once

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The radius that FreeSurfer and Connectome Workbench give their spheres.
constexpr double brain_sphere_radius = 100;

/// The cut mesh on the sphere of this radius about the origin. The first vertices and all faces are those of
/// the input in their order; maps onto the whole sphere have no further ones. Vertices that no face uses lie
/// at the north pole. Throws ArgumentError if the map is not onto a sphere, or the radius not positive.
PolygonMesh sphere_surface(const Embedding& embedding, double radius = brain_sphere_radius);

}  // namespace orbitutte
