// SPDX-License-Identifier: MIT
// Files of meshes some of whose faces have more than three corners.
#include <fmt/compile.h>

#include <algorithm>

#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/obj_lines.h"
#include "orbitutte/io/ply_triangles.h"

namespace orbitutte {
namespace {

FaceView faces_of(const PolygonMesh& mesh) { return {mesh.corners, mesh.face_start}; }

// The corners, counted from `first`.
void append_line(std::string& text, const std::string& keyword, std::span<const int> corners, int first) {
  text += keyword;
  for (const int v : corners) fmt::format_to(std::back_inserter(text), FMT_COMPILE(" {}"), 1LL * v + first);
  text += '\n';
}

}  // namespace

std::string write_obj_polygons(const PolygonMesh& mesh) {
  std::string text;
  append_obj_vertices(mesh.V, text);
  for (int f = 0; f < mesh.face_count(); ++f) append_line(text, "f", faces_of(mesh)[f], 1);
  return text;
}

std::string write_off_polygons(const PolygonMesh& mesh) {
  std::string text = fmt::format("OFF\n{} {} 0\n", mesh.vertex_count(), mesh.face_count());
  for (const auto& position : mesh.V.rowwise())
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{} {} {}\n"), position[0], position[1],
                   position[2]);
  for (int f = 0; f < mesh.face_count(); ++f)
    append_line(text, std::to_string(mesh.face_degree(f)), faces_of(mesh)[f], 0);
  return text;
}

std::string write_ply_polygons(const PolygonMesh& mesh) {
  return write_ply_faces(mesh.V, faces_of(mesh), {}, {});
}

}  // namespace orbitutte
