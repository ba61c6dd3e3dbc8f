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
/// - OBJ: `v`, `f` with v, v/vt, v//vn, v/vt/vn, negative indices; three numbers after the coordinates are
///   the vertex's colour; `l`, `p` and everything else are ignored.
/// - OFF: the keyword (OFF after any of ST, C, N) may be missing; after a keyword, the count of edges may be
///   missing, and so may the blank before the counts. With C, vertices may have colours. Other columns and
///   comments are ignored. If there are no other columns, the numbers may stand in any lines. Binary files
///   and dimensions other than three are refused.
/// - PLY: ASCII, binary of both byte orders, `face` (vertex_indices or vertex_index) and `tristrips`;
///   colours are `red`, `green` and `blue` of the vertices; other elements and properties are ignored.
/// - STL: ASCII with any number of solids, and binary; corners with the same three coordinates are one
///   vertex, numbered in order of first use. Facets with two corners at the same point are left out, with a
///   warning. So are bytes after the last facet, unless they may be facets.
///
/// Colours are numbers of 0 .. 1 or 0 .. 255: the latter if they are integers of a PLY or one of them is
/// above 1. If some vertices have no colour, the mesh has none. If a colour makes no sense, the mesh has
/// none either, and there is a warning.
///
/// Indices are not compared with the number of vertices, nor coordinates with infinity: `inspect` does both.
/// PolygonMesh::warnings says what was ignored that may matter. Throws MeshError naming the line, element or
/// byte if the data are empty, cut short or make no sense.
PolygonMesh parse_mesh(std::string_view bytes, MeshFormat format);

/// Reads a file in the format that the path's ending names, as parse_mesh does. Error messages begin with
/// the path. Throws FileError if the file cannot be read; ArgumentError and MeshError.
PolygonMesh read_mesh(const std::string& path);

/// The text or bytes of a mesh file. Positions read back as the same doubles (STL: rounded to single
/// precision). Throws MeshError if the format is STL and a face names a vertex that does not exist.
std::string serialize_mesh(const Mesh& mesh, MeshFormat format);

/// The same with faces of any number of corners. Throws MeshError if the format is STL and a face is not a
/// triangle.
std::string serialize_mesh(const PolygonMesh& mesh, MeshFormat format);

/// Writes a file in the format that the path's ending names, as serialize_mesh does. The file appears whole
/// or not at all. Throws FileError, ArgumentError and MeshError.
void write_mesh(const std::string& path, const Mesh& mesh);
void write_mesh(const std::string& path, const PolygonMesh& mesh);

}  // namespace orbitutte
