// SPDX-License-Identifier: MIT
// Mesh files: OBJ, OFF, PLY and STL. The order of vertices and faces in the file is the order in the result.
#pragma once

#include <string>
#include <string_view>

#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

enum class MeshFormat { obj, off, ply, stl };

/// The format that a path's ending names (any case). Throws ArgumentError naming the endings known.
MeshFormat mesh_format(const std::string& path);

/// The polygons in the text or bytes of a mesh file.
/// OBJ: `v`, `f` with v, v/vt, v//vn, v/vt/vn, negative indices; `l`, `p` and all else are passed over.
/// OFF: with or without counts of edges, comments, colours; also COFF, NOFF, STOFF, 4OFF is refused.
/// PLY: ASCII, binary of both byte orders, `face` (vertex_indices or vertex_index) and `tristrips`; other elements
/// and properties are passed over. STL: ASCII and binary; corners with the same three coordinates are one vertex,
/// numbered in order of first use.
/// Indices are not compared with the number of vertices, nor coordinates with infinity: `inspect` does both.
/// Throws MeshError naming the line, element or byte where the data are empty, cut short or make no sense.
PolygonMesh parse_mesh(std::string_view bytes, MeshFormat format);

/// parse_mesh of a file; messages begin with the path. Throws FileError when it cannot be read, and MeshError.
PolygonMesh read_mesh(const std::string& path);

/// Writes triangles in the format that the path's ending names; positions with 17 digits or as doubles where the
/// format can (STL: single precision). The file appears whole or not at all. Throws FileError, ArgumentError.
void write_mesh(const std::string& path, const Mesh& mesh);

}  // namespace orbitutte
