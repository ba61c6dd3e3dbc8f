// SPDX-License-Identifier: MIT
// What messages, pictures and pages call a target and the space that it lies in.
#pragma once

#include <string>

#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// "group of order 24", "finite group" where the order is not stated (cones of angles), "infinite group", or
/// "no group" where copies of the tile do not fill the space.
std::string group_text(const Target& target);

/// "the sphere", "the Euclidean plane" or "the hyperbolic plane".
std::string text_of(Space space);

/// Where a map to the space lies: "on the sphere", "in the plane" or "in the hyperbolic plane".
std::string place_in(Space space);

/// Where pictures show it (DrawnSpace): "on the sphere", "in the plane" or "in Poincaré's disk".
std::string drawn_in(Space space);

/// "sphere", "disk", "projective plane" or "other surface".
std::string text_of(Topology topology);

}  // namespace orbitutte
