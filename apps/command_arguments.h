// SPDX-License-Identifier: MIT
// Arguments that several commands share.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/weights.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte::cli {

/// Vertices separated by commas. Throws ArgumentError.
std::vector<int> parse_cones(const std::string& text);

/// The kind of weights that a name tells. Throws ArgumentError naming all.
WeightKind parse_weights(const std::string& text);

/// The mesh that was embedded, its polygons divided, and the embedding's faces in the same triangles. Throws
/// FileError, and MeshError naming the first defect; where the embedding is none of the mesh, what takes both
/// tells.
Mesh read_in_triangles(const std::string& path, Embedding& embedding);

}  // namespace orbitutte::cli
