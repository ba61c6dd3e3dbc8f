// SPDX-License-Identifier: MIT
// The layout of nearly all large PLY files, read without the detour over PlyFile: binary, first vertices with
// x, y, z of one floating-point type among other numbers, then nothing but triangles `uchar int int int`.
#include <array>
#include <cstdint>
#include <limits>

#include "orbitutte/mesh/bytes.h"
#include "orbitutte/mesh/mesh_formats.h"
#include "orbitutte/mesh/ply_header.h"

namespace orbitutte {

namespace {

struct VertexLayout {
  std::size_t size = 0;                ///< of a vertex, in bytes
  std::array<std::size_t, 3> axis_at;  ///< x, y, z: bytes from the beginning of a vertex
  PlyType type;                        ///< of x, y and z: float32 or float64
};

constexpr std::size_t triangle_size = sizeof(std::uint8_t) + 3 * sizeof(std::int32_t);

/// None where the vertices have lists, or x, y, z are not of one floating-point type.
std::optional<VertexLayout> vertex_layout(const PlyElement& element) {
  const PlyProperty* const axes[] = {element.find("x"), element.find("y"), element.find("z")};
  for (const PlyProperty* axis : axes) {
    if (axis == nullptr || is_integer(axis->type) || axis->type != axes[0]->type) return std::nullopt;
  }
  VertexLayout layout;
  layout.type = axes[0]->type;
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) return std::nullopt;
    for (int k = 0; k < 3; ++k) {
      if (&property == axes[k]) layout.axis_at[k] = layout.size;
    }
    layout.size += size_of(property.type);
  }
  return layout;
}

/// The list of vertices; null where faces have other properties or the list has other types.
const PlyProperty* triangle_list(const PlyElement& element) {
  if (element.properties.size() != 1) return nullptr;
  const PlyProperty& list = element.properties.front();
  const bool is_named = list.name == "vertex_indices" || list.name == "vertex_index";
  const bool is_typed = list.is_list && list.count_type == PlyType::uint8 &&
                        (list.type == PlyType::int32 || list.type == PlyType::uint32);
  return is_named && is_typed ? &list : nullptr;
}

template <class T, std::endian order>
Points load_points(const char* bytes, const VertexLayout& layout, std::size_t count) {
  Points V(count, 3);
  for (std::size_t v = 0; v < count; ++v, bytes += layout.size) {
    for (int k = 0; k < 3; ++k) V(v, k) = load<T>(bytes + layout.axis_at[k], order);
  }
  return V;
}

/// The corners of `count` triangles; none where a face is no triangle or an index does not fit into an int.
template <std::endian order>
std::optional<std::vector<int>> load_corners(const char* bytes, bool is_unsigned, std::size_t count) {
  std::vector<int> corners(3 * count);
  for (std::size_t f = 0; f < count; ++f, bytes += triangle_size) {
    if (*bytes != 3) return std::nullopt;
    for (int k = 0; k < 3; ++k) {
      const auto index = load<std::int32_t>(bytes + 1 + k * sizeof(std::int32_t), order);
      if (is_unsigned && index < 0) return std::nullopt;
      corners[3 * f + k] = index;
    }
  }
  return corners;
}

template <std::endian order>
std::optional<PolygonMesh> load_mesh(const char* vertices, std::size_t vertex_count,
                                     const VertexLayout& layout, std::size_t face_count, bool is_unsigned) {
  const char* faces = vertices + vertex_count * layout.size;
  std::optional<std::vector<int>> corners = load_corners<order>(faces, is_unsigned, face_count);
  if (!corners) return std::nullopt;
  PolygonMesh mesh;
  mesh.corners = std::move(*corners);
  mesh.face_start.resize(face_count + 1);
  for (std::size_t f = 0; f <= face_count; ++f) mesh.face_start[f] = static_cast<int>(3 * f);
  mesh.V = layout.type == PlyType::float32 ? load_points<float, order>(vertices, layout, vertex_count)
                                           : load_points<double, order>(vertices, layout, vertex_count);
  return mesh;
}

}  // namespace

std::optional<PolygonMesh> read_ply_triangles(std::string_view bytes, const PlyHeader& header) {
  const std::vector<PlyElement>& elements = header.file.elements;
  if (!header.byte_order || elements.size() != 2) return std::nullopt;
  const PlyElement &vertex = elements[0], &face = elements[1];
  if (vertex.name != "vertex" || face.name != "face") return std::nullopt;
  const std::optional<VertexLayout> layout = vertex_layout(vertex);
  const PlyProperty* list = triangle_list(face);
  constexpr std::size_t most = std::numeric_limits<int>::max();
  if (!layout || list == nullptr || vertex.count > most || 3 * face.count > most) return std::nullopt;
  const std::string_view data = bytes.substr(header.size);
  if (data.size() != vertex.count * layout->size + face.count * triangle_size) return std::nullopt;

  const auto load = *header.byte_order == std::endian::little ? load_mesh<std::endian::little>
                                                              : load_mesh<std::endian::big>;
  return load(data.data(), vertex.count, *layout, face.count, list->type == PlyType::uint32);
}

}  // namespace orbitutte
