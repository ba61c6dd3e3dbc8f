// SPDX-License-Identifier: MIT
// FreeSurfer's triangle files (lh.pial, lh.white, lh.sphere ...): three bytes, two lines, counts, single
// precision positions and indices, the highest byte of each number first.
#include <fmt/format.h>

#include <cstdint>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/mesh_formats.h"

namespace orbitutte {
namespace {

constexpr std::string_view triangle_start = "\xFF\xFF\xFE", quadrangle_start = "\xFF\xFF\xFF",
                           new_quadrangle_start = "\xFF\xFF\xFD";
constexpr std::size_t number_size = 4, three_numbers = 3 * number_size;

std::int32_t load_int(std::string_view bytes) { return load<std::int32_t>(bytes.data(), std::endian::big); }

void check_kind(std::string_view bytes) {
  if (bytes.starts_with(triangle_start)) return;
  if (bytes.starts_with(quadrangle_start) || bytes.starts_with(new_quadrangle_start))
    throw MeshError(
        "the file is a FreeSurfer surface of quadrangles; convert it to one of triangles with mris_convert");
  throw MeshError(
      "the file does not begin with the three bytes FF FF FE of a FreeSurfer surface; check that it is one");
}

// What follows the two lines of text.
std::string_view behind_text(std::string_view bytes) {
  for (int line = 0; line < 2; ++line) {
    const std::size_t end = bytes.find('\n');
    if (end == bytes.npos)
      throw MeshError("the file ends within its first two lines; copy or export it again");
    bytes.remove_prefix(end + 1);
  }
  return bytes;
}

struct Counts {
  std::int32_t vertices, faces;
};

Counts read_counts(std::string_view bytes) {
  if (bytes.size() < 2 * number_size)
    throw MeshError("the file ends before its counts; copy or export it again");
  const Counts counts = {load_int(bytes), load_int(bytes.substr(number_size))};
  const auto size = [](std::int32_t count) { return three_numbers * static_cast<std::size_t>(count); };
  if (counts.vertices < 0 || counts.faces < 0 ||
      size(counts.vertices) + size(counts.faces) > bytes.size() - 2 * number_size)
    throw MeshError(fmt::format(
        "the file promises {} vertices and {} faces, but only {} bytes follow; copy or export it again",
        counts.vertices, counts.faces, bytes.size() - 2 * number_size));
  return counts;
}

}  // namespace

// What follows the faces (the volume's geometry) is ignored: positions stay as they are.
PolygonMesh read_freesurfer(std::string_view bytes) {
  check_kind(bytes);
  bytes = behind_text(bytes.substr(triangle_start.size()));
  const Counts counts = read_counts(bytes);
  bytes.remove_prefix(2 * number_size);
  PolygonMesh mesh;
  mesh.V.resize(counts.vertices, 3);
  for (std::int32_t v = 0; v < counts.vertices; ++v)
    for (int axis = 0; axis < 3; ++axis, bytes.remove_prefix(number_size))
      mesh.V(v, axis) = load<float>(bytes.data(), std::endian::big);
  mesh.corners.reserve(3 * static_cast<std::size_t>(counts.faces));
  mesh.face_start.reserve(counts.faces + std::size_t{1});
  for (std::int32_t f = 0; f < counts.faces; ++f) {
    for (int k = 0; k < 3; ++k, bytes.remove_prefix(number_size)) mesh.corners.push_back(load_int(bytes));
    end_face(mesh);
  }
  return mesh;
}

std::string write_freesurfer(const Mesh& mesh) {
  std::string bytes(triangle_start);
  bytes += "created by orbitutte\n\n";
  bytes.reserve(bytes.size() + 2 * number_size + three_numbers * (mesh.V.rows() + mesh.F.rows()));
  append_big_endian(bytes, static_cast<std::int32_t>(mesh.V.rows()));
  append_big_endian(bytes, static_cast<std::int32_t>(mesh.F.rows()));
  for (const auto& position : mesh.V.rowwise())
    for (const double x : position) append_big_endian(bytes, static_cast<float>(x));
  for (const auto& face : mesh.F.rowwise())
    for (const int v : face) append_big_endian(bytes, static_cast<std::int32_t>(v));
  return bytes;
}

}  // namespace orbitutte
