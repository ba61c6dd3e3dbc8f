// SPDX-License-Identifier: MIT
#include "orbitutte/report/embedding_file.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/io/ply_triangles.h"
#include "orbitutte/mesh/triangulation.h"

namespace orbitutte {
namespace {

void require(const PlyElement& element, const char* property, bool is_list) {
  const PlyProperty* found = element.find(property);
  if (!found || found->is_list != is_list)
    throw MeshError(
        fmt::format("the element '{}' has no {} property '{}'; is this an embedding written by orbitutte?",
                    element.name, is_list ? "list" : "scalar", property));
}

const PlyElement& require(const PlyFile& file, const char* element) {
  const PlyElement* found = file.find(element);
  if (!found)
    throw MeshError(
        fmt::format("there is no element '{}'; is this an embedding written by orbitutte?", element));
  return *found;
}

void require_properties(const PlyFile& file) {
  const PlyElement &vertex = require(file, "vertex"), &face = require(file, "face");
  for (const char* property : {"x", "y", "z", "source_vertex"}) require(vertex, property, false);
  require(face, "vertex_indices", true);
}

int to_index(double value, int limit, const char* what, std::size_t of) {
  if (!(value >= 0) || value >= limit || value != std::floor(value))
    throw MeshError(fmt::format("{} {} names the vertex {}, but there are {}", what, of, value, limit));
  return static_cast<int>(value);
}

template <typename Number>
std::vector<int> to_source_vertices(const std::vector<Number>& values) {
  std::vector<int> sources;
  sources.reserve(values.size());
  for (const Number value : values)
    sources.push_back(
        to_index(value, static_cast<int>(values.size()), "the source of cut vertex", sources.size()));
  return sources;
}

constexpr const char* offset_properties[] = {"dx", "dy", "dz"};

// `offset`: a row per offset, or no element at all if there are none.
std::vector<PlyElement> offset_elements(const std::vector<Offset>& offsets) {
  if (offsets.empty()) return {};
  PlyElement element = {"offset", offsets.size(), std::vector<PlyProperty>(4)};
  PlyProperty& vertex = element.properties.front();
  vertex.name = "vertex";
  vertex.type = PlyType::int32;
  for (const Offset& offset : offsets) vertex.values.push_back(offset.vertex);
  for (int k = 0; k < 3; ++k) {
    PlyProperty& property = element.properties[k + 1];
    property.name = offset_properties[k];
    for (const Offset& offset : offsets) property.values.push_back(offset.d[k]);
  }
  return {std::move(element)};
}

// Ascending by vertex, those of one vertex in the order of the file.
std::vector<Offset> to_offsets(const PlyElement& element, int vertices) {
  require(element, "vertex", false);
  for (const char* property : offset_properties) require(element, property, false);
  std::vector<Offset> offsets(element.count);
  for (std::size_t i = 0; i < element.count; ++i) {
    offsets[i].vertex = to_index(element.find("vertex")->values[i], vertices, "offset", i);
    for (int k = 0; k < 3; ++k) offsets[i].d[k] = element.find(offset_properties[k])->values[i];
    if (!offsets[i].d.allFinite())
      throw MeshError(fmt::format("offset {}, of vertex {}, is not finite", i, offsets[i].vertex));
  }
  std::stable_sort(offsets.begin(), offsets.end(),
                   [](const Offset& a, const Offset& b) { return a.vertex < b.vertex; });
  return offsets;
}

void take_vertices_and_offsets(std::string_view bytes, const PlyHeader& header, Embedding& embedding) {
  if (const auto values = read_ply_integers(bytes, header, "source_vertex")) {
    embedding.source_vertex = to_source_vertices(*values);
    return;
  }
  const PlyFile file = parse_ply(bytes);
  embedding.source_vertex = to_source_vertices(file.find("vertex")->find("source_vertex")->values);
  if (const PlyElement* element = file.find("offset"))
    embedding.offsets = to_offsets(*element, static_cast<int>(embedding.source_vertex.size()));
}

void check_faces(const PolygonMesh& mesh) {
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_degree(f) < 3) throw MeshError(fmt::format("face {} has fewer than three corners", f));
    for (int c = mesh.face_start[f]; c < mesh.face_start[f + 1]; ++c)
      to_index(mesh.corners[c], mesh.vertex_count(), "face", static_cast<std::size_t>(f));
  }
}

void take_faces(PolygonMesh& mesh, Embedding& embedding) {
  check_faces(mesh);
  if (is_triangle_mesh(mesh)) {
    embedding.triangles = Eigen::Map<const Triangles>(mesh.corners.data(), mesh.face_count(), 3);
    return;
  }
  embedding.polygons = {std::move(mesh.corners), std::move(mesh.face_start)};
  embedding.triangles = triangles_on_vertices(fan_triangles(embedding.polygons), embedding.polygons.corners);
}

}  // namespace

std::string serialize_embedding(const Embedding& embedding) {
  return write_ply_faces(embedding.positions, embedding.faces(), {{"source_vertex", embedding.source_vertex}},
                         {fmt::format("orbitutte embedding {}", embedding.target.signature)},
                         offset_elements(embedding.offsets));
}

Embedding parse_embedding(std::string_view bytes) {
  const PlyHeader header = parse_ply_header(bytes);
  require_properties(header.file);
  PolygonMesh mesh = parse_mesh(bytes, MeshFormat::ply);
  Embedding embedding;
  take_vertices_and_offsets(bytes, header, embedding);
  take_faces(mesh, embedding);
  embedding.positions = std::move(mesh.V);
  return embedding;
}

std::vector<std::string> warnings_of_offsets(const Embedding& embedding) {
  if (embedding.offsets.empty()) return {};
  int vertices = 0, last = -1;
  for (const Offset& offset : embedding.offsets)
    if (std::exchange(last, offset.vertex) != offset.vertex) ++vertices;
  return {
      fmt::format("{} cut vertices, the first {}, lie closer together than doubles resolve; their offsets "
                  "are not used here, so faces may coincide there",
                  vertices, embedding.offsets.front().vertex)};
}

Embedding read_embedding(const std::string& path) { return parse_file(path, parse_embedding); }

}  // namespace orbitutte
