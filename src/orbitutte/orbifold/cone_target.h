// SPDX-License-Identifier: MIT
// Surfaces of constant curvature with cones and corners of any angles (W. P. Thurston, "Shapes of polyhedra
// and triangulations of the sphere", 1998; M. Troyanov, "Prescribing curvature on compact surfaces with
// conical singularities", 1991).
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// The target with cones (rotation) and corners of these angles: a sphere with cones alone, or a disk whose
/// cones come first and lie inside, and whose corners follow in the order of the boundary. By Gauss and
/// Bonnet, curvature * area is total_curvature, whose sign decides the space. Angles that are flat but for
/// rounding (1e-9) are corrected to be flat. Throws ArgumentError if an angle is not positive and finite, if
/// a corner stands before a cone or on a sphere, or for another topology.
Target cone_target(Topology topology, std::vector<Mark> marks);

/// Do the signature's angles stand apart from it: is it `cones` or `*cones`?
bool takes_angles(const std::string& signature);

/// What the mesh of such a signature must be.
Topology topology_of_cones(const std::string& signature);

/// 2 pi chi - sum of (2 pi - angle) over the cones - sum of (pi - angle) over the corners, radians.
double total_curvature(Topology topology, const std::vector<Mark>& marks);

/// The area of a target whose tile is free, by Gauss and Bonnet. In the plane, where any tile may be scaled,
/// it is a choice: 1 for disks, and 2, one for each side, for spheres.
double free_tile_area(const Target& target);

/// By how many whole turns the angle of a mark exceeds one of 2 pi, or of pi at a corner.
int turns_in_excess(const Mark& mark);

}  // namespace orbitutte
