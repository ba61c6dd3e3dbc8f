// SPDX-License-Identifier: MIT
// Polygons of given angles whose sides all touch one circle.
#pragma once

#include <vector>

#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// The corners of the polygon, counterclockwise around (0, 0, 1), the centre of its inscribed circle. By
/// Gauss and Bonnet the angles decide the space. An angle above pi makes it run backwards around the centre
/// there.
Points inscribed_polygon(Space space, const std::vector<double>& angles);

}  // namespace orbitutte
