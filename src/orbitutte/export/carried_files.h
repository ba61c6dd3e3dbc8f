// SPDX-License-Identifier: MIT
// What a map carried from one surface to another, as files; and a morph as a row of meshes.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/export/map_files.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// Vertices of an embedded surface as points of it. Throws ArgumentError naming the vertex if it does not
/// exist or no face uses it.
SurfacePoints points_at_vertices(const Embedding& embedding, const std::vector<int>& vertices);

/// Curves as an OBJ of vertices and lines, one `l` a curve. curves: k x 3 each.
std::string curves_obj(const std::vector<Points>& curves);

/// The bytes of a surface with colours of its vertices (n x 3, sRGB, 0 .. 1): PLY or OBJ, as the path's
/// ending says. Throws ArgumentError for another ending, or if there are more or fewer colours than vertices.
std::string coloured_mesh(const std::string& path, const Surface& surface, const Points& colours);

/// The paths of the frames of a morph: morph_00.ply, morph_01.ply, ... for morph.ply. Throws ArgumentError if
/// there are fewer than two or more than 10,000.
std::vector<std::string> frame_paths(const std::string& path, int count);

/// Writes the morph in so many equal steps, the first on A, the last on B, in the format that the path's
/// ending names, as write_mesh has it. Throws as frame_paths and write_mesh do.
void write_morph_frames(const std::string& path, const Morph& morph, int count);

}  // namespace orbitutte
