// SPDX-License-Identifier: MIT
#include "orbitutte/io/ply_triangles.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>

#include "orbitutte/io/bytes.h"
#include "orbitutte/io/ply_colours.h"

namespace orbitutte {

namespace {

struct VertexLayout {
  /// Of a vertex, in bytes.
  std::size_t size = 0;
  /// X, y, z: bytes from the beginning of a vertex.
  std::array<std::size_t, 3> axis_at;
  /// Of x, y and z: float32 or float64.
  PlyType type;
};

/// A file of the layout.
struct TriangleFile {
  std::endian order;
  VertexLayout vertex;
  std::size_t vertex_count;
  std::size_t face_count;
  bool has_unsigned_corners;
  /// The faces follow.
  const char* vertices;
};

constexpr std::size_t triangle_size = sizeof(std::uint8_t) + 3 * sizeof(std::int32_t);

/// The bytes of an element's scalars before the property, or of all of them if it is null.
std::size_t size_before(const PlyElement& element, const PlyProperty* wanted) {
  std::size_t size = 0;
  for (const PlyProperty& property : element.properties) {
    if (&property == wanted) break;
    size += size_of(property.type);
  }
  return size;
}

/// Nothing if the vertices have lists, or if x, y, z are not of one floating-point type.
std::optional<VertexLayout> vertex_layout(const PlyElement& element) {
  for (const PlyProperty& property : element.properties) {
    if (property.is_list) return std::nullopt;
  }
  const PlyProperty* const axes[] = {element.find("x"), element.find("y"), element.find("z")};
  for (const PlyProperty* axis : axes) {
    if (axis == nullptr || is_integer(axis->type) || axis->type != axes[0]->type) return std::nullopt;
  }
  VertexLayout layout;
  layout.size = size_before(element, nullptr);
  for (int k = 0; k < 3; ++k) layout.axis_at[k] = size_before(element, axes[k]);
  layout.type = axes[0]->type;
  return layout;
}

/// The list of vertices; null if faces have other properties or the list has other types.
const PlyProperty* triangle_list(const PlyElement& element) {
  if (element.properties.size() != 1) return nullptr;
  const PlyProperty& list = element.properties.front();
  const bool is_named = list.name == "vertex_indices" || list.name == "vertex_index";
  const bool is_typed = list.is_list && list.count_type == PlyType::uint8 &&
                        (list.type == PlyType::int32 || list.type == PlyType::uint32);
  return is_named && is_typed ? &list : nullptr;
}

/// Nothing if the file has another layout.
std::optional<TriangleFile> triangle_file(std::string_view bytes, const PlyHeader& header) {
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
  return TriangleFile{*header.byte_order, *layout, vertex.count, face.count, list->type == PlyType::uint32,
                      data.data()};
}

template <class T, std::endian order>
Points load_points(const TriangleFile& file) {
  Points V(file.vertex_count, 3);
  const char* vertex = file.vertices;
  for (std::size_t v = 0; v < file.vertex_count; ++v, vertex += file.vertex.size) {
    for (int k = 0; k < 3; ++k) V(v, k) = load<T>(vertex + file.vertex.axis_at[k], order);
  }
  return V;
}

/// The colours of the vertices; none if they have none.
VertexColours load_colours(const TriangleFile& file, const PlyElement& vertex) {
  const PlyChannels channels = find_channels(vertex);
  if (!channels.problem.empty()) return no_colours(channels.problem);
  if (!channels.are_there()) return {};
  Points values(file.vertex_count, 3);
  for (int k = 0; k < 3; ++k) {
    visit_type(channels.channel[k]->type, [&](auto number) {
      const char* at = file.vertices + size_before(vertex, channels.channel[k]);
      for (std::size_t v = 0; v < file.vertex_count; ++v, at += file.vertex.size)
        values(v, k) = static_cast<double>(load<decltype(number)>(at, file.order));
    });
  }
  return colours_of_channels(channels, values);
}

/// Nothing if a face is not a triangle or an index does not fit into an int.
template <std::endian order>
std::optional<std::vector<int>> load_corners(const TriangleFile& file) {
  std::vector<int> corners(3 * file.face_count);
  const char* face = file.vertices + file.vertex_count * file.vertex.size;
  for (std::size_t f = 0; f < file.face_count; ++f, face += triangle_size) {
    if (*face != 3) return std::nullopt;
    for (int k = 0; k < 3; ++k) {
      const auto index = load<std::int32_t>(face + 1 + k * sizeof(std::int32_t), order);
      if (file.has_unsigned_corners && index < 0) return std::nullopt;
      corners[3 * f + k] = index;
    }
  }
  return corners;
}

template <std::endian order>
std::optional<PolygonMesh> load_mesh(const TriangleFile& file) {
  std::optional<std::vector<int>> corners = load_corners<order>(file);
  if (!corners) return std::nullopt;
  PolygonMesh mesh;
  mesh.corners = std::move(*corners);
  mesh.face_start.resize(file.face_count + 1);
  for (std::size_t f = 0; f <= file.face_count; ++f) mesh.face_start[f] = static_cast<int>(3 * f);
  mesh.V = file.vertex.type == PlyType::float32 ? load_points<float, order>(file)
                                                : load_points<double, order>(file);
  return mesh;
}

PlyProperty scalar(std::string name, PlyType type) {
  PlyProperty property;
  property.name = std::move(name);
  property.type = type;
  return property;
}

/// The elements, without values.
PlyFile layout_of(std::size_t vertices, const FaceView& faces, const std::vector<PlyIntegers>& further) {
  PlyElement vertex = {"vertex", vertices, {}};
  for (const char* axis : {"x", "y", "z"}) vertex.properties.push_back(scalar(axis, PlyType::float64));
  for (const PlyIntegers& column : further) vertex.properties.push_back(scalar(column.name, PlyType::int32));
  PlyProperty list = scalar("vertex_indices", PlyType::int32);
  list.is_list = true;
  list.count_type = corner_count_type(faces);
  return {{}, {std::move(vertex), {"face", static_cast<std::size_t>(faces.count()), {std::move(list)}}}};
}

/// The corners after their number, which is a Count.
template <class Count>
void append_faces(std::string& bytes, const FaceView& faces) {
  for (int f = 0; f < faces.count(); ++f) {
    const std::span<const int> face = faces[f];
    const auto count = static_cast<Count>(face.size());
    if (face.size() == 3) {
      append_little_endian(bytes, count, face[0], face[1], face[2]);
      continue;
    }
    append_little_endian(bytes, count);
    for (const int v : face) append_little_endian(bytes, v);
  }
}

void check_size(const PlyIntegers& column, std::size_t vertices) {
  if (column.values.size() == vertices) return;
  throw ArgumentError(
      fmt::format("property '{}' does not have one value for each of {} vertices", column.name, vertices));
}

}  // namespace

std::optional<PolygonMesh> read_ply_triangles(std::string_view bytes, const PlyHeader& header) {
  const std::optional<TriangleFile> file = triangle_file(bytes, header);
  if (!file) return std::nullopt;
  std::optional<PolygonMesh> mesh = file->order == std::endian::little ? load_mesh<std::endian::little>(*file)
                                                                       : load_mesh<std::endian::big>(*file);
  if (mesh) give_colours(load_colours(*file, header.file.elements.front()), *mesh);
  return mesh;
}

std::optional<std::vector<int>> read_ply_integers(std::string_view bytes, const PlyHeader& header,
                                                  std::string_view property) {
  const std::optional<TriangleFile> file = triangle_file(bytes, header);
  if (!file) return std::nullopt;
  const PlyElement& vertex = header.file.elements.front();
  const PlyProperty* column = vertex.find(property);
  if (column == nullptr || column->type != PlyType::int32) return std::nullopt;
  std::vector<int> values(file->vertex_count);
  const char* at = file->vertices + size_before(vertex, column);
  for (int& value : values) {
    value = load<std::int32_t>(at, file->order);
    at += file->vertex.size;
  }
  return values;
}

PlyType corner_count_type(const FaceView& faces) {
  std::size_t most = 3;
  for (int f = 0; f < faces.count(); ++f) most = std::max(most, faces[f].size());
  return most > 255 ? PlyType::int32 : PlyType::uint8;
}

std::string write_ply_triangles(const Points& V, const Triangles& F,
                                const std::vector<PlyIntegers>& further_properties,
                                const std::vector<std::string>& comments) {
  return write_ply_faces(V, FaceView(F), further_properties, comments);
}

std::string write_ply_faces(const Points& V, const FaceView& faces,
                            const std::vector<PlyIntegers>& further_properties,
                            const std::vector<std::string>& comments,
                            const std::vector<PlyElement>& further_elements) {
  const auto vertices = static_cast<std::size_t>(V.rows());
  for (const PlyIntegers& column : further_properties) check_size(column, vertices);
  PlyFile layout = layout_of(vertices, faces, further_properties);
  layout.comments = comments;
  layout.elements.insert(layout.elements.end(), further_elements.begin(), further_elements.end());
  std::string bytes = serialize_ply_header(layout);
  bytes.reserve(bytes.size() + vertices * size_before(layout.elements.front(), nullptr) +
                static_cast<std::size_t>(faces.count()) * triangle_size);
  for (std::size_t v = 0; v < vertices; ++v) {
    append_little_endian(bytes, V(v, 0), V(v, 1), V(v, 2));
    for (const PlyIntegers& column : further_properties) append_little_endian(bytes, column.values[v]);
  }
  if (layout.elements[1].properties.front().count_type == PlyType::uint8) {
    append_faces<std::uint8_t>(bytes, faces);
  } else {
    append_faces<std::int32_t>(bytes, faces);
  }
  for (const PlyElement& element : further_elements) append_element(bytes, element);
  return bytes;
}

}  // namespace orbitutte
