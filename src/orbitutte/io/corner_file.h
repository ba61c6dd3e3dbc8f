// SPDX-License-Identifier: MIT
// Files that say where on the sphere vertices of a boundary are held.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// The corners of a polygon: a line `vertex x y z` for each; empty lines and what follows a `#` are passed
/// over. A position may be off the unit sphere by 1e-3, as rounded decimals are, and is put there. Throws
/// FileError, and MeshError naming the line and the vertex where it is further off or no such line.
std::vector<PolygonCorner> read_corners(const std::string& path);

}  // namespace orbitutte
