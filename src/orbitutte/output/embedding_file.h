// SPDX-License-Identifier: MIT
// The embedding as a file: a binary PLY of the cut mesh on the unit sphere.
#pragma once

#include <string>
#include <string_view>

#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The bytes of the PLY: vertices with double x, y, z and int source_vertex; faces as lists vertex_indices.
std::string serialize_embedding(const Embedding& embedding);

/// Positions, faces and source vertices of such bytes. Throws MeshError naming what is missing or out of
/// range.
Embedding parse_embedding(std::string_view bytes);

/// Positions, faces and source vertices of such a file; what the report holds (signature, group order, seams,
/// cones) stays empty. Polygons, which are convex, are divided into triangles from their first corners.
/// Throws FileError, and MeshError naming what is missing or out of range.
Embedding read_embedding(const std::string& path);

/// The triangles of the embedding's polygons, as those of the mesh that was embedded are divided (T x 3):
/// what a file does not tell. The polygons must be those of the mesh, in its order.
Faces cut_triangles(const PolygonMesh& mesh, const Triangulation& triangulation, const Embedding& embedding);

}  // namespace orbitutte
