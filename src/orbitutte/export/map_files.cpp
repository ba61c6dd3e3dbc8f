// SPDX-License-Identifier: MIT
#include "orbitutte/export/map_files.h"

#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

#include "orbitutte/export/gltf_model.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {
namespace {

void require_same_size(const Points& from, const Points& to) {
  if (from.rows() != to.rows())
    throw ArgumentError("the positions in the beginning and in the end differ in number");
}

}  // namespace

void write_vertex_map(const std::string& path, const VertexMap& map) {
  write_file(path, point_lines(map.images));
}

void write_overlay(const std::string& path, const Overlay& overlay, const Points& positions) {
  PolygonMesh mesh;
  mesh.V = positions;
  mesh.corners = overlay.faces.corners;
  mesh.face_start = overlay.faces.start;
  write_mesh(path, mesh);
}

Morph morph_of(const Overlay& overlay, const Points& on_a, const Points& on_b) {
  require_same_size(on_a, on_b);
  return {overlay_triangles(overlay).triangles, on_a, on_b};
}

Points morph_positions(const Morph& morph, double t) { return (1 - t) * morph.from + t * morph.to; }

void write_morph(const std::string& path, const Morph& morph) {
  require_same_size(morph.from, morph.to);
  constexpr std::size_t bytes_per_vertex = 12 * sizeof(float), bytes_per_triangle = 3 * sizeof(std::uint32_t);
  check_glb_size(bytes_per_vertex * static_cast<std::size_t>(morph.from.rows()) +
                     bytes_per_triangle * static_cast<std::size_t>(morph.triangles.rows()),
                 path);
  const Points normals = vertex_normals(morph.from, morph.triangles),
               normals_at_end = vertex_normals(morph.to, morph.triangles);
  GltfModel model;
  const std::vector<std::uint32_t> indices(morph.triangles.data(),
                                           morph.triangles.data() + morph.triangles.size());
  model.add_primitive({{"POSITION", model.add_positions(morph.from)}, {"NORMAL", model.add_vectors(normals)}},
                      model.add_triangles(indices),
                      model.add_material("surface", {200, 200, 200}, GltfModel::Sides::both));
  model.add_morph_target({{"POSITION", model.add_positions(morph.to - morph.from)},
                          {"NORMAL", model.add_vectors(normals_at_end - normals)}});
  model.animate_morph({0, 1, 3, 4, 6}, {0, 0, 1, 1, 0});
  write_file(path, model.bytes());
}

}  // namespace orbitutte
