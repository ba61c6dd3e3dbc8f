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

/// Reads the mesh of an embedding, and divides the embedding's faces into the same triangles. Throws
/// FileError, and MeshError naming the first defect. Does not check that the embedding is one of the mesh;
/// functions that take both do.
Surface read_source(const std::string& path, Embedding& embedding);

}  // namespace orbitutte::cli
