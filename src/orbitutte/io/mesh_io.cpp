// SPDX-License-Identifier: MIT
#include "orbitutte/io/mesh_io.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/file_ending.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/mesh/triangulation.h"

namespace orbitutte {

namespace {

struct FormatRow {
  MeshFormat format;
  // The first is the usual one; separated by blanks.
  std::string_view endings;
  PolygonMesh (*read)(std::string_view);
  std::string (*write)(const Mesh&);
  // triangles_only: polygons are divided into triangles.
  std::string (*write_polygons)(const PolygonMesh&);
};

constexpr std::nullptr_t triangles_only = nullptr;

constexpr FormatRow formats[] = {
    {MeshFormat::obj, ".obj", read_obj, write_obj, write_obj_polygons},
    {MeshFormat::off, ".off", read_off, write_off, write_off_polygons},
    {MeshFormat::ply, ".ply", read_ply, write_ply, write_ply_polygons},
    {MeshFormat::stl, ".stl", read_stl, write_stl, triangles_only},
    {MeshFormat::gifti, ".gii", read_gifti, write_gifti, triangles_only},
    {MeshFormat::vtk, ".vtk", read_vtk, write_vtk, write_vtk_polygons},
    {MeshFormat::vtp, ".vtp", read_vtp, write_vtp, write_vtp_polygons},
    {MeshFormat::gltf, ".gltf", read_gltf, write_gltf, triangles_only},
    {MeshFormat::glb, ".glb", read_gltf, write_glb, triangles_only},
    {MeshFormat::freesurfer, ".pial .white .inflated .sphere .orig .smoothwm .reg .nofix", read_freesurfer,
     write_freesurfer, triangles_only}};

constexpr std::string_view gzip_magic = "\x1F\x8B";
constexpr const char* standard_input = "-";

const FormatRow& row(MeshFormat format) {
  return *std::find_if(std::begin(formats), std::end(formats),
                       [format](const FormatRow& known) { return known.format == format; });
}

/// Does the text have two bytes per character, one of which is zero in all characters that the formats use?
/// The byte order mark or the first two characters tell.
bool is_utf16(std::string_view bytes) {
  if (bytes.starts_with("\xFF\xFE") || bytes.starts_with("\xFE\xFF")) return true;
  if (bytes.size() < 4) return false;
  const bool zero[] = {bytes[0] == 0, bytes[1] == 0, bytes[2] == 0, bytes[3] == 0};
  return zero[0] == zero[2] && zero[1] == zero[3] && zero[0] != zero[1];
}

// "a, b, c" of all endings.
std::string known_endings() {
  std::string endings;
  for (const FormatRow& known : formats) fmt::format_to(std::back_inserter(endings), "{} ", known.endings);
  endings.pop_back();
  for (std::size_t at = 0; (at = endings.find(' ', at)) != std::string::npos; at += 2)
    endings.replace(at, 1, ", ");
  return endings;
}

}  // namespace

std::vector<std::string> mesh_endings() {
  std::vector<std::string> endings;
  for (const FormatRow& known : formats)
    endings.emplace_back(known.endings.substr(0, known.endings.find(' ')));
  return endings;
}

MeshFormat mesh_format(const std::string& path) {
  const std::string ending = ending_of(without_gz(path));
  for (const FormatRow& known : formats)
    if (!ending.empty() && has_word(known.endings, ending)) return known.format;
  throw ArgumentError(fmt::format(
      "{}: the ending names no known mesh format; use one of {}, each also with .gz", path, known_endings()));
}

PolygonMesh parse_mesh(std::string_view bytes, MeshFormat format) {
  if (bytes.empty()) throw MeshError("the file is empty; export it again");
  try {
    return row(format).read(bytes);
  } catch (const MeshError&) {
    if (is_utf16(bytes)) throw MeshError("the file is UTF-16 text; save it as UTF-8");
    throw;
  }
}

PolygonMesh parse_mesh_file(const std::string& path, std::string_view bytes) {
  const MeshFormat format = mesh_format(path);
  return naming_file(path, [&] {
    return is_compressed(path) ? parse_mesh(decompress(bytes), format) : parse_mesh(bytes, format);
  });
}

PolygonMesh read_mesh(const std::string& path) {
  mesh_format(path);  // refuses what has no known ending before it is read
  return parse_mesh_file(path, read_file(path));
}

MeshFormat mesh_format(const MeshInput& input) {
  if (input.format) return *input.format;
  if (input.path != standard_input) return mesh_format(input.path);
  throw ArgumentError(
      fmt::format("the mesh comes from standard input, whose format no ending names; give --format {}",
                  listed_choices(choices_of<MeshFormat>())));
}

std::string read_bytes(const MeshInput& input) {
  mesh_format(input);  // refuses what has no known format before it is read
  return input.path == standard_input ? read_standard_input() : read_file(input.path);
}

PolygonMesh parse_mesh_input(const MeshInput& input, std::string_view bytes) {
  if (!input.format) return parse_mesh_file(input.path, bytes);
  return naming_file(input.path, [&] {
    return bytes.starts_with(gzip_magic) ? parse_mesh(decompress(bytes), *input.format)
                                         : parse_mesh(bytes, *input.format);
  });
}

PolygonMesh read_mesh(const MeshInput& input) { return parse_mesh_input(input, read_bytes(input)); }

std::string serialize_mesh(const Mesh& mesh, MeshFormat format) { return row(format).write(mesh); }

std::string serialize_mesh(const PolygonMesh& mesh, MeshFormat format) {
  const FormatRow& known = row(format);
  if (is_triangle_mesh(mesh) || !known.write_polygons) return known.write(to_triangle_mesh(mesh));
  return known.write_polygons(mesh);
}

void write_mesh(const std::string& path, const Mesh& mesh) {
  write_compressed_as_named(path, serialize_mesh(mesh, mesh_format(path)));
}

void write_mesh(const std::string& path, const PolygonMesh& mesh) {
  write_compressed_as_named(path, serialize_mesh(mesh, mesh_format(path)));
}

}  // namespace orbitutte
