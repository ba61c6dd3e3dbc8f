// SPDX-License-Identifier: MIT
// The sides of a fixed polygon, as the certificate sees them.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// What keeps a boundary from running once around the sides of a convex polygon, a sentence each: it has to
/// meet the corners in their order, and between two of them its vertices have to lie on the great arc that
/// joins them (to 1e-12), each strictly further along than the one before. Empty where nothing does.
/// positions: n_cut x 3, unit; boundary: cut vertices along the boundary's half-edges; corners: cut vertices,
/// as the convex polygon has them counterclockwise.
std::vector<std::string> departures_from_sides(const Points& positions, std::vector<int> boundary,
                                               const std::vector<int>& corners);

}  // namespace orbitutte
