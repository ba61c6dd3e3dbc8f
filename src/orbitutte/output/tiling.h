// SPDX-License-Identifier: MIT
// The whole sphere: |G| copies of an embedding, welded along its seams into one closed mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

struct Tiling {
  Mesh mesh;                   ///< closed, on the unit sphere, every triangle counterclockwise from outside
  std::vector<int> tile;       ///< m |G|: the group element (index into the group) whose copy of the tile holds the face
  std::vector<int> source_face;    ///< m |G|: the face of the input mesh
  std::vector<int> source_vertex;  ///< the input vertex of every vertex
  int tiles = 0;               ///< |G|
};

/// Welds combinatorially: copy g of left[i] is copy g*transform of right[i]; positions are never compared.
/// Vertices that no face uses are left out. Throws ArgumentError where the seams do not generate a group of order
/// embedding.group_order, and MemoryError-free std::bad_alloc where the result does not fit.
Tiling tile_sphere(const Embedding& embedding);

/// Writes PLY (binary; face colours, `tile` and `source_face` per face), OBJ (a group and material per tile, the .mtl beside
/// it), STL (binary, colour in the attribute word) or GLB (one primitive per colour on shared vertices), as the path's
/// ending says. Neighbouring tiles differ in colour; mirrored tiles are a shade darker. The file appears whole or not at all.
/// Throws ArgumentError for another ending, FileError.
void write_tiling(const std::string& path, const Tiling& tiling);

}  // namespace orbitutte
