// SPDX-License-Identifier: MIT
// Mesh files: OBJ, OFF, PLY, STL, GIfTI, FreeSurfer, VTK and glTF. The order of vertices and faces in the
// file is the order in the result.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/names.h"

namespace orbitutte {

enum class MeshFormat { obj, off, ply, stl, gifti, freesurfer, vtk, vtp, gltf, glb };

/// Its names.
template <>
struct NameTable<MeshFormat> {
  static constexpr NamedValue<MeshFormat> rows[] = {
      {MeshFormat::obj, "obj"},     {MeshFormat::off, "off"},
      {MeshFormat::ply, "ply"},     {MeshFormat::stl, "stl"},
      {MeshFormat::vtk, "vtk"},     {MeshFormat::vtp, "vtp"},
      {MeshFormat::gltf, "gltf"},   {MeshFormat::glb, "glb"},
      {MeshFormat::gifti, "gifti"}, {MeshFormat::freesurfer, "freesurfer"}};
};

/// Where a mesh is read from.
struct MeshInput {
  /// Of a file; "-" is standard input, which can be read once.
  std::string path;

  /// If none is given, the one that the path's ending names.
  std::optional<MeshFormat> format = {};
};

/// The format that a path's ending names (any case), or the one before `.gz`: .obj, .off, .ply, .stl, .gii
/// (GIfTI), .vtk, .vtp, .gltf, .glb; FreeSurfer's .pial, .white, .inflated, .sphere, .orig, .smoothwm, .reg
/// and .nofix. Throws ArgumentError naming the endings known.
MeshFormat mesh_format(const std::string& path);

/// The usual ending of every format.
std::vector<std::string> mesh_endings();

/// The polygons in the text or bytes of a mesh file.
///
/// - OBJ: `v`, `f` with v, v/vt, v//vn, v/vt/vn, negative indices; three numbers after the coordinates are
///   the vertex's colour; `l`, `p` and everything else are ignored.
/// - OFF: the keyword (OFF after any of ST, C, N) may be missing; after a keyword, the count of edges may be
///   missing, and so may the blank before the counts. With C, vertices may have colours. Other columns and
///   comments are ignored. If there are no other columns, the numbers may stand in any lines. Binary files
///   (OFF BINARY) have numbers of four bytes, the highest first. Dimensions other than three are refused.
/// - PLY: ASCII, binary of both byte orders, `face` (vertex_indices or vertex_index) and `tristrips`;
///   colours are `red`, `green` and `blue` of the vertices; other elements and properties are ignored.
/// - STL: ASCII with any number of solids, and binary; corners with the same three coordinates are one
///   vertex, numbered in order of first use. Facets with two corners at the same point are left out, with a
///   warning. So are bytes after the last facet, unless they may be facets.
/// - GIfTI: the arrays of points and of triangles, of any number type, byte order, index order and encoding
///   but external files. A transform that the file states is not applied, with a warning.
/// - FreeSurfer: surfaces of triangles. What follows the faces is ignored.
/// - VTK: legacy files of polygonal data, text and binary: polygons and strips of triangles; vertices, lines
///   and data are ignored.
/// - VTP: VTK's XML files of polygonal data, with arrays as text, base64 or raw bytes, inside or appended,
///   compressed by zlib or not; pieces follow each other. What is ignored is the same.
/// - glTF: the triangles, strips and fans of all meshes. Vertices are the same where primitives name the same
///   accessor of positions, and are not welded further. Transforms of nodes are not applied, with a warning;
///   buffers in other files, sparse accessors and compressed meshes are refused.
///
/// Colours are numbers of 0 .. 1 or 0 .. 255: the latter if they are integers of a PLY or one of them is
/// above 1. If some vertices have no colour, the mesh has none. If a colour makes no sense, the mesh has
/// none either, and there is a warning.
///
/// Indices are not compared with the number of vertices, nor coordinates with infinity: `inspect` does both.
/// PolygonMesh::warnings says what was ignored that may matter. Throws MeshError naming the line, element or
/// byte if the data are empty, cut short or make no sense.
PolygonMesh parse_mesh(std::string_view bytes, MeshFormat format);

/// The polygons in the bytes of the file at this path, whose ending names the format, and of which `.gz` says
/// that they are compressed. Error messages begin with the path. Throws ArgumentError and MeshError.
PolygonMesh parse_mesh_file(const std::string& path, std::string_view bytes);

/// The format of the input. Throws ArgumentError if nothing names it.
MeshFormat mesh_format(const MeshInput& input);

/// The bytes of the file or of standard input. Throws ArgumentError if nothing names their format, and
/// FileError.
std::string read_bytes(const MeshInput& input);

/// The polygons in the bytes of the input. If its format was given, bytes that begin as gzip's do are
/// decompressed first. Error messages begin with the path. Throws ArgumentError and MeshError.
PolygonMesh parse_mesh_input(const MeshInput& input, std::string_view bytes);

/// Reads the mesh. Throws as the functions above do.
PolygonMesh read_mesh(const MeshInput& input);

/// Reads a file in the format that the path's ending names, as parse_mesh does; one that ends in `.gz` is
/// decompressed first. Error messages begin with the path. Throws FileError if the file cannot be read;
/// ArgumentError and MeshError.
PolygonMesh read_mesh(const std::string& path);

/// The text or bytes of a mesh file. Positions read back as the same doubles (STL, GIfTI, FreeSurfer, glTF:
/// rounded to single precision). Throws MeshError if the format is STL and a face names a vertex that does
/// not exist, or if it is glTF and the mesh is empty or a position not finite.
std::string serialize_mesh(const Mesh& mesh, MeshFormat format);

/// The same with faces of any number of corners. Throws MeshError if the format has triangles only (STL,
/// GIfTI, FreeSurfer, glTF) and a face is none.
std::string serialize_mesh(const PolygonMesh& mesh, MeshFormat format);

/// Writes a file in the format that the path's ending names, as serialize_mesh does, compressed if that is
/// followed by `.gz`. The file appears whole or not at all. Throws FileError, ArgumentError and MeshError.
void write_mesh(const std::string& path, const Mesh& mesh);
void write_mesh(const std::string& path, const PolygonMesh& mesh);

}  // namespace orbitutte
