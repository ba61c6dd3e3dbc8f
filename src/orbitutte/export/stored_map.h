// SPDX-License-Identifier: MIT
// A map between two surfaces, read from its files.
#pragma once

#include <string>

#include "orbitutte/map/surface_map.h"

namespace orbitutte {

/// The map in a folder that `orbitutte map -o` has written (a.ply, a.json, b.ply, b.json, map.json), of the
/// surfaces a and b. Both embeddings are certified anew. Of Minimum, energy, history and whether it converged
/// are known; of MapClass, the tile. Throws FileError, and MeshError naming the file and what is missing in
/// it, or if a file is of another surface.
SurfaceMap read_surface_map(const std::string& folder, const Surface& a, const Surface& b);

}  // namespace orbitutte
