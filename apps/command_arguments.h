// SPDX-License-Identifier: MIT
// Arguments that several commands share.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte::cli {

/// Vertices separated by commas. Throws ArgumentError.
std::vector<int> parse_cones(const std::string& text);

/// Reads the mesh of an embedding, whose faces are divided into the same triangles. Throws FileError, and
/// MeshError naming the first defect; where the embedding is none of the mesh, what takes both tells.
Surface read_source(const std::string& path, Embedding& embedding);

}  // namespace orbitutte::cli
