// SPDX-License-Identifier: MIT
// The search for the vertices at which cones of fitted angles distort least.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/cones/fitted_angles.h"

namespace orbitutte {

/// The best that is found: one cone after the other where it helps most, among some vertices that are spread
/// over the surface (spread_candidates); exchanges of single cones as long as they help; and moves of single
/// cones over the mesh, uphill along the potential of what is left of u. Throws as fit_angles does; MeshError
/// if 30 cones do not reach `sigma`, or if more do not help.
FittedCones place_cones(const ScaleKernel& kernel, const ConeWishes& wishes);

/// The angles flat_angle/n of least sigma with n = 2 .. highest_order, by descent over single orders from
/// those nearest to the angles of the best fit; the area is what they make it. Throws as fit_angles does.
FittedAngles fit_orders(const ScaleKernel& kernel, const std::vector<int>& cones, int highest_order = 12);

}  // namespace orbitutte
