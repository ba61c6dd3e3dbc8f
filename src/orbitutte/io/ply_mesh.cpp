// SPDX-License-Identifier: MIT
// Meshes in PLY files: the elements `vertex` and `face` as Greg Turk named them, and the `tristrips` of the
// Stanford 3D Scanning Repository.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>

#include "orbitutte/io/mesh_formats.h"
#include "orbitutte/io/ply_colours.h"
#include "orbitutte/io/ply_header.h"
#include "orbitutte/io/ply_triangles.h"

namespace orbitutte {

namespace {

constexpr int strip_end = -1;

// The coordinates are found first: without them nothing in the file bounds the count.
Points positions(const PlyElement& vertex) {
  std::array<const PlyProperty*, 3> axes = {};
  for (int k = 0; k < 3; ++k) {
    const char* name = std::array{"x", "y", "z"}[k];
    axes[k] = vertex.find(name);
    if (axes[k] == nullptr || axes[k]->is_list)
      throw MeshError(
          fmt::format("the element 'vertex' has no coordinate '{}'; export the file again", name));
  }
  Points V(checked_count(vertex.count, "vertices"), 3);
  for (int k = 0; k < 3; ++k)
    for (Eigen::Index v = 0; v < V.rows(); ++v) V(v, k) = axes[k]->values[v];
  return V;
}

VertexColours colours(const PlyElement& vertex) {
  const PlyChannels channels = find_channels(vertex);
  if (!channels.problem.empty()) return no_colours(channels.problem);
  if (!channels.are_there()) return {};
  Points values(static_cast<Eigen::Index>(vertex.count), 3);
  for (int k = 0; k < 3; ++k)
    for (Eigen::Index v = 0; v < values.rows(); ++v) values(v, k) = channels.channel[k]->values[v];
  return colours_of_channels(channels, values);
}

const PlyProperty& index_lists(const PlyElement& element) {
  for (const std::string_view name : {"vertex_indices", "vertex_index"}) {
    const PlyProperty* lists = element.find(name);
    if (lists != nullptr && lists->is_list) return *lists;
  }
  throw MeshError(
      fmt::format("the element '{}' has no list 'vertex_indices'; export the file again", element.name));
}

int to_index(double value, const PlyElement& element, std::size_t item) {
  constexpr int lowest = std::numeric_limits<int>::min(), highest = std::numeric_limits<int>::max();
  const bool is_integer = value == std::trunc(value);
  if (is_integer && value >= lowest && value <= highest) return static_cast<int>(value);
  throw MeshError(fmt::format("{} {} has the index {}, which {}; export the file again", element.name, item,
                              value, is_integer ? "is out of range" : "is not an integer"));
}

void append_faces(const PlyElement& element, PolygonMesh& mesh) {
  const PlyProperty& lists = index_lists(element);
  for (std::size_t f = 0; f < element.count; ++f) {
    for (std::size_t k = lists.list_start[f]; k < lists.list_start[f + 1]; ++k) {
      mesh.corners.push_back(to_index(lists.values[k], element, f));
    }
    end_face(mesh);
  }
}

/// In a strip a b c d e ... every vertex ends a triangle with the two before it: a b c, c b d, c d e, ...
void append_strips(const PlyElement& element, PolygonMesh& mesh) {
  const PlyProperty& lists = index_lists(element);
  for (std::size_t strip = 0; strip < element.count; ++strip) {
    int before_last = 0, last = 0;
    std::size_t length = 0;
    for (std::size_t k = lists.list_start[strip]; k < lists.list_start[strip + 1]; ++k) {
      const int index = to_index(lists.values[k], element, strip);
      if (index == strip_end) {
        length = 0;
        continue;
      }
      if (length >= 2) {
        const bool is_turned = length % 2 != 0;
        mesh.corners.insert(mesh.corners.end(),
                            {is_turned ? last : before_last, is_turned ? before_last : last, index});
        end_face(mesh);
      }
      before_last = last;
      last = index;
      ++length;
    }
  }
}

PolygonMesh to_mesh(const PlyFile& file) {
  const PlyElement* vertex = file.find("vertex");
  if (vertex == nullptr) throw MeshError("there is no element 'vertex'; check that the file holds a mesh");
  PolygonMesh mesh;
  mesh.V = positions(*vertex);
  give_colours(colours(*vertex), mesh);
  const PlyElement* faces = file.find("face");
  const PlyElement* strips = file.find("tristrips");
  if (faces != nullptr && faces->count > 0) append_faces(*faces, mesh);
  if (strips != nullptr && strips->count > 0) append_strips(*strips, mesh);
  return mesh;
}

}  // namespace

PolygonMesh read_ply(std::string_view bytes) {
  if (auto mesh = read_ply_triangles(bytes, parse_ply_header(bytes))) return std::move(*mesh);
  return to_mesh(parse_ply(bytes));
}

std::string write_ply(const Mesh& mesh) { return write_ply_triangles(mesh.V, mesh.F); }

}  // namespace orbitutte
