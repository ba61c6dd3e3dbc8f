// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/polygon_mesh.h"

#include <fmt/format.h>

#include <algorithm>

namespace orbitutte {

PolygonMesh to_polygon_mesh(const Mesh& mesh) {
  PolygonMesh polygons;
  polygons.V = mesh.V;
  polygons.corners.assign(mesh.F.data(), mesh.F.data() + mesh.F.size());
  polygons.face_start.resize(mesh.F.rows() + 1);
  for (int f = 0; f <= mesh.F.rows(); ++f) polygons.face_start[f] = 3 * f;
  return polygons;
}

Mesh to_triangle_mesh(PolygonMesh mesh) {
  for (int f = 0; f < mesh.face_count(); ++f) {
    if (mesh.face_degree(f) == 3) continue;
    throw MeshError(
        fmt::format("face {} has {} corners instead of three; triangulate the mesh", f, mesh.face_degree(f)));
  }
  Mesh triangles{std::move(mesh.V), Triangles(mesh.face_count(), 3)};
  std::copy(mesh.corners.begin(), mesh.corners.end(), triangles.F.data());
  return triangles;
}

}  // namespace orbitutte
