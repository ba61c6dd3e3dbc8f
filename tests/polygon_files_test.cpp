// SPDX-License-Identifier: MIT
// Files of polygons.
#include <gmock/gmock.h>

#include <cmath>

#include "orbitutte/io/mesh_io.h"

namespace orbitutte::polygon_files_test {
namespace {

// A pyramid on a base of five corners, whose coordinates have no short decimals.
PolygonMesh pyramid() {
  PolygonMesh mesh;
  mesh.V.resize(6, 3);
  for (int k = 0; k < 5; ++k) mesh.V.row(k) << std::cos(1.2566 * k), std::sin(1.2566 * k), -1.0 / 3;
  mesh.V.row(5) << 0, 1e-300, 1;
  mesh.corners = {4, 3, 2, 1, 0, 0, 1, 5, 1, 2, 5, 2, 3, 5, 3, 4, 5, 4, 0, 5};
  mesh.face_start = {0, 5, 8, 11, 14, 17, 20};
  return mesh;
}

TEST(PolygonFiles, ReadBackAsTheyWereWritten) {
  const PolygonMesh mesh = pyramid();
  for (const MeshFormat format : {MeshFormat::obj, MeshFormat::off, MeshFormat::ply}) {
    const PolygonMesh read = parse_mesh(serialize_mesh(mesh, format), format);
    EXPECT_EQ(read.V, mesh.V);
    EXPECT_EQ(read.corners, mesh.corners);
    EXPECT_EQ(read.face_start, mesh.face_start);
  }
}

TEST(PolygonFiles, TrianglesAreTheSameBytesEitherWay) {
  const Mesh triangles = {pyramid().V, (Triangles(2, 3) << 0, 1, 5, 1, 2, 5).finished()};
  for (const MeshFormat format : {MeshFormat::obj, MeshFormat::off, MeshFormat::ply, MeshFormat::stl})
    EXPECT_EQ(serialize_mesh(to_polygon_mesh(triangles), format), serialize_mesh(triangles, format));
}

TEST(PolygonFiles, StlHoldsNoPolygons) {
  EXPECT_THROW(serialize_mesh(pyramid(), MeshFormat::stl), MeshError);
}

}  // namespace
}  // namespace orbitutte::polygon_files_test
