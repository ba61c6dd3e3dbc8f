// SPDX-License-Identifier: MIT
// The embedding as a file: a binary PLY of the cut mesh on the unit sphere.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The bytes of the PLY: vertices with double x, y, z and int source_vertex; faces as lists vertex_indices;
/// where there are offsets, elements `offset` with int vertex and double dx, dy, dz.
std::string serialize_embedding(const Embedding& embedding);

/// Positions, faces, source vertices and offsets of such bytes. Throws MeshError naming what is missing or
/// out of range.
Embedding parse_embedding(std::string_view bytes);

/// Positions, faces, source vertices and offsets of such a file. What the report holds (signature, group
/// order, seams, cones) stays empty. Polygons, which are convex, are divided into triangles from their first
/// corners. Throws FileError, and MeshError naming what is missing or out of range.
Embedding read_embedding(const std::string& path);

/// What a program should say that uses the doubles of the positions alone. None, or one warning if there are
/// offsets.
std::vector<std::string> warnings_of_offsets(const Embedding& embedding);

}  // namespace orbitutte
