// SPDX-License-Identifier: MIT
#include "orbitutte/export/tiling_files.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <filesystem>
#include <iterator>

#include "orbitutte/export/closed_mesh.h"
#include "orbitutte/export/gltf_model.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/obj_lines.h"
#include "orbitutte/io/ply_triangles.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/names.h"

namespace orbitutte {
namespace {

/// Blue in the lowest 5 bits, then green and red; the top bit says that there is a colour (VisCAM's
/// convention).
std::uint16_t stl_attribute(const Rgb& colour) {
  return static_cast<std::uint16_t>(0x8000 | (colour.red >> 3) << 10 | (colour.green >> 3) << 5 |
                                    colour.blue >> 3);
}

void append_stl_vector(std::string& bytes, const Eigen::Vector3f& vector) {
  for (const float x : vector) append_little_endian(bytes, x);
}

/// Triangles whose corners stay apart in single precision. The other two edges of one whose do not are the
/// same.
std::vector<Eigen::Index> triangles_in_single_precision(const Mesh& mesh) {
  std::vector<Eigen::Index> kept;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const auto corner = [&](int k) -> Eigen::Vector3f {
      return mesh.V.row(mesh.F(f, k)).cast<float>().transpose();
    };
    if (corner(0) != corner(1) && corner(1) != corner(2) && corner(2) != corner(0)) kept.push_back(f);
  }
  return kept;
}

/// Readers of STL weld corners by their positions: what they find must be a surface, too.
void require_surface_when_read(const std::string& path, const std::string& stl, const Tiling& tiling) {
  const PolygonMesh read = read_stl(stl);
  const Eigen::Index lost = tiling.mesh.V.rows() - read.V.rows();
  if (lost == 0 || inspect(read).defects.empty()) return;
  throw MeshError(fmt::format(
      "{}: STL has single precision, in which {} vertices of the tiling fall on others, so that it is no "
      "surface; write .ply or .obj, which keep all digits",
      path, lost));
}

int faces_in_copy(const Tiling& tiling) { return std::max(1, static_cast<int>(tiling.input_faces.size())); }

/// If two polygons share two vertices that no edge joins, diagonals of both may coincide.
void require_closed_triangles(const Tiling& tiling) {
  if (tiling.polygons.count() > 0) require_closed_sphere(tiling.mesh);
}

void write_stl_file(const std::string& path, const Tiling& tiling) {
  require_closed_triangles(tiling);
  const std::string bytes = stl_bytes(tiling);
  require_surface_when_read(path, bytes, tiling);
  write_file(path, bytes);
}

void write_obj_and_mtl(const std::string& path, const Tiling& tiling) {
  std::filesystem::path library = path;
  library.replace_extension(".mtl");
  write_file(library.string(), mtl_text(tiling));
  write_file(path, obj_text(tiling, library.filename().string()));
}

}  // namespace

TileMaterials tile_materials(const Tiling& tiling) {
  TileMaterials result;
  for (const TileCopy& copy : tiling.copies) {
    const std::string name = fmt::format("colour_{}{}", copy.colour, copy.mirrored ? "_mirrored" : "");
    const auto found = std::find_if(result.materials.begin(), result.materials.end(),
                                    [&](const TileMaterial& material) { return material.name == name; });
    result.of_copy.push_back(static_cast<int>(found - result.materials.begin()));
    if (found == result.materials.end())
      result.materials.push_back({name, tile_colour(copy.colour, copy.mirrored)});
  }
  return result;
}

// Does not use PlyFile, which holds every number as a double: 2.8 GB more for 32 million faces.
std::string ply_bytes(const Tiling& tiling) {
  const Mesh& mesh = tiling.mesh;
  const FaceView faces = tiling.faces();
  const int faces_per_copy = faces_in_copy(tiling);
  const PlyType count_type = corner_count_type(faces);
  std::string bytes = fmt::format(
      "ply\nformat binary_little_endian 1.0\ncomment tiling of the sphere by {} copies\n"
      "element vertex {}\nproperty double x\nproperty double y\nproperty double z\nproperty int "
      "source_vertex\n"
      "element face {}\nproperty list {} int vertex_indices\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty int tile\nproperty int "
      "source_face\n"
      "end_header\n",
      tiling.copy_count(), mesh.V.rows(), faces.count(), ply_type_name(count_type));
  constexpr std::size_t vertex_size = 3 * sizeof(double) + sizeof(int);
  constexpr std::size_t face_size = 1 + 3 * sizeof(int) + 3 + 2 * sizeof(int);
  bytes.reserve(bytes.size() + vertex_size * mesh.V.rows() + face_size * mesh.F.rows());

  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    for (int k = 0; k < 3; ++k) append_little_endian(bytes, mesh.V(v, k));
    append_little_endian(bytes, tiling.source_vertex[v]);
  }
  for (int f = 0; f < faces.count(); ++f) {  // copy by copy
    visit_type(count_type,
               [&](auto type) { append_little_endian(bytes, static_cast<decltype(type)>(faces[f].size())); });
    for (const int v : faces[f]) append_little_endian(bytes, v);
    const TileCopy& copy = tiling.copies[f / faces_per_copy];
    const Rgb colour = tile_colour(copy.colour, copy.mirrored);
    for (const std::uint8_t channel : {colour.red, colour.green, colour.blue})
      append_little_endian(bytes, channel);
    append_little_endian(bytes, f / faces_per_copy);
    append_little_endian(bytes, tiling.input_faces[f % faces_per_copy]);
  }
  return bytes;
}

std::string stl_bytes(const Tiling& tiling) {
  const Mesh& mesh = tiling.mesh;
  std::string bytes = fmt::format("binary STL: tiling of the sphere by {} copies", tiling.copy_count());
  const std::vector<Eigen::Index> kept = triangles_in_single_precision(mesh);
  bytes.reserve(84 + 50 * kept.size());
  bytes.resize(80, ' ');
  append_little_endian(bytes, static_cast<std::uint32_t>(kept.size()));
  for (const Eigen::Index f : kept) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
    append_stl_vector(bytes, (b - a).cross(c - a).stableNormalized().cast<float>());
    for (const Vector3* corner : {&a, &b, &c}) append_stl_vector(bytes, corner->cast<float>());
    const TileCopy& copy = tiling.copies[tiling.copy[f]];
    append_little_endian(bytes, stl_attribute(tile_colour(copy.colour, copy.mirrored)));
  }
  return bytes;
}

std::string mtl_text(const Tiling& tiling) {
  std::string text;
  for (const auto& [name, colour] : tile_materials(tiling).materials)
    fmt::format_to(std::back_inserter(text), "newmtl {}\nKd {:.4f} {:.4f} {:.4f}\n", name, colour.red / 255.0,
                   colour.green / 255.0, colour.blue / 255.0);
  return text;
}

std::string obj_text(const Tiling& tiling, const std::string& library) {
  const TileMaterials materials = tile_materials(tiling);
  const Mesh& mesh = tiling.mesh;
  std::string text = fmt::format("mtllib {}\n", library);
  const auto out = std::back_inserter(text);
  append_obj_vertices(mesh.V, text);
  const FaceView faces = tiling.faces();
  const int faces_per_copy = faces_in_copy(tiling);
  int copy = -1;
  for (int f = 0; f < faces.count(); ++f) {
    if (f / faces_per_copy != copy) {
      copy = f / faces_per_copy;
      fmt::format_to(out, "g tile_{}\nusemtl {}\n", copy, materials.materials[materials.of_copy[copy]].name);
    }
    text += 'f';
    for (const int v : faces[f]) fmt::format_to(out, FMT_COMPILE(" {}"), v + 1);
    text += '\n';
  }
  return text;
}

namespace {

bool are_unit_vectors(const Points& V) {
  constexpr double rounding = 1e-6;  // of single precision
  return ((V.rowwise().squaredNorm().array() - 1).abs() < rounding).all();
}

}  // namespace

std::string glb_bytes(const Tiling& tiling) {
  const Triangles& F = tiling.mesh.F;
  check_glb_size(3 * sizeof(float) * tiling.mesh.V.rows() + 3 * sizeof(std::uint32_t) * F.rows(),
                 "the tiling");
  const TileMaterials materials = tile_materials(tiling);
  GltfModel model;
  // A point of the unit sphere is its own normal, so positions and normals share the same bytes.
  const int positions = model.add_positions(tiling.mesh.V);
  const int normals =
      are_unit_vectors(tiling.mesh.V) ? positions : model.add_vectors(vertex_normals(tiling.mesh.V, F));
  for (int m = 0; m < static_cast<int>(materials.materials.size()); ++m) {
    std::vector<std::uint32_t> indices;
    for (Eigen::Index f = 0; f < F.rows(); ++f)
      if (materials.of_copy[tiling.copy[f]] == m)
        for (int k = 0; k < 3; ++k) indices.push_back(static_cast<std::uint32_t>(F(f, k)));
    const auto& [name, colour] = materials.materials[m];
    model.add_primitive({{"POSITION", positions}, {"NORMAL", normals}}, model.add_triangles(indices),
                        model.add_material(name, colour, GltfModel::Sides::front));
  }
  return model.bytes();
}

namespace {

void write_ply_file(const std::string& path, const Tiling& tiling) { write_file(path, ply_bytes(tiling)); }

void write_glb_file(const std::string& path, const Tiling& tiling) {
  require_closed_triangles(tiling);
  write_file(path, glb_bytes(tiling));
}

struct TilingFormat {
  const char* ending;
  void (*write)(const std::string& path, const Tiling& tiling);
};

constexpr TilingFormat tiling_formats[] = {{".ply", write_ply_file},
                                           {".obj", write_obj_and_mtl},
                                           {".glb", write_glb_file},
                                           {".stl", write_stl_file}};

}  // namespace

std::vector<std::string> tiling_endings() {
  std::vector<std::string> endings;
  for (const TilingFormat& format : tiling_formats) endings.emplace_back(format.ending);
  return endings;
}

void write_tiling(const std::string& path, const Tiling& tiling) {
  const std::string ending = ending_of(path);
  for (const TilingFormat& format : tiling_formats)
    if (ending == format.ending) return format.write(path, tiling);
  throw ArgumentError(fmt::format("{}: a tiling is written as {}", path, listed_choices(tiling_endings())));
}

}  // namespace orbitutte
