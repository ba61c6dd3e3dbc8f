// SPDX-License-Identifier: MIT
// Files that say where on the sphere vertices of a boundary are held.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// The corners of a polygon: a line `vertex x y z` for each. Empty lines and what follows a `#` are ignored.
/// A position may be off the unit sphere by up to 1e-3, as rounded decimals are; it is moved onto the
/// sphere. Throws FileError; MeshError naming the line, and the vertex if there is one, if a position is
/// further off or a line is not of this form.
std::vector<PolygonCorner> read_corners(const std::string& path);

}  // namespace orbitutte
