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
///
/// - OBJ: `v`, `f` with v, v/vt, v//vn, v/vt/vn, negative indices; three numbers behind the coordinates are
///   the vertex's colour; `l`, `p` and all else are passed over.
/// - OFF: the keyword (OFF, behind any of ST, C, N) may be missing, and behind it the count of edges, or the
///   blank before the counts; with C, vertices may have colours; other columns and comments are passed over;
///   where there are no other columns, the numbers may stand in any lines; binary files and other dimensions
///   than three are refused.
/// - PLY: ASCII, binary of both byte orders, `face` (vertex_indices or vertex_index) and `tristrips`; colours
///   are `red`, `green` and `blue` of the vertices; other elements and properties are passed over.
/// - STL: ASCII with any number of solids, and binary; corners with the same three coordinates are one
///   vertex, numbered in order of first use. Facets with two corners at the same point are left out, with a
///   warning, as are bytes behind the last facet, unless they may be facets.
///
/// Colours are numbers of 0 .. 1 or 0 .. 255: the latter if they are integers of a PLY or one is above 1. The
/// mesh has none if some vertices have none, and none, with a warning, if one makes no sense.
///
/// Indices are not compared with the number of vertices, nor coordinates with infinity: `inspect` does both.
/// What was passed over that may matter is in PolygonMesh::warnings.
/// Throws MeshError naming the line, element or byte where the data are empty, cut short or make no sense.
PolygonMesh parse_mesh(std::string_view bytes, MeshFormat format);

/// parse_mesh of a file in the format that the path's ending names; messages of errors begin with the path.
/// Throws FileError when it cannot be read, ArgumentError and MeshError.
PolygonMesh read_mesh(const std::string& path);

/// The text or bytes of a mesh file. Positions read back as the same doubles (STL: rounded to single
/// precision). Throws MeshError where the format is STL and a face names a vertex that is not there.
std::string serialize_mesh(const Mesh& mesh, MeshFormat format);

/// The same with faces of any number of corners. Throws MeshError where the format is STL and a face is no
/// triangle.
std::string serialize_mesh(const PolygonMesh& mesh, MeshFormat format);

/// serialize_mesh to a file in the format that the path's ending names. The file appears whole or not at all.
/// Throws FileError, ArgumentError and MeshError.
void write_mesh(const std::string& path, const Mesh& mesh);
void write_mesh(const std::string& path, const PolygonMesh& mesh);

}  // namespace orbitutte
