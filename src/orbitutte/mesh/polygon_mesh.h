// SPDX-License-Identifier: MIT
// The content of a mesh file: polygons in the order of the file, not yet judged.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// A mesh of polygons as it stands in a file. Nothing is promised about it: indices may be out of range and
/// coordinates not finite until `inspect` has looked at it.
struct PolygonMesh {
  /// n x 3 positions.
  Points V;
  /// The vertices of all faces, one face after the other.
  std::vector<int> corners;
  /// Face f is corners[face_start[f]] .. corners[face_start[f + 1] - 1].
  std::vector<int> face_start = {0};
  /// n x 3, the colours of the vertices in sRGB, 0 .. 1; or empty.
  Points colours = Points(0, 3);
  /// What the reader of the file ignored or took for something else, one sentence each.
  std::vector<std::string> warnings = {};

  int vertex_count() const { return static_cast<int>(V.rows()); }
  int face_count() const { return static_cast<int>(face_start.size()) - 1; }
  int face_degree(int f) const { return face_start[f + 1] - face_start[f]; }
};

/// The same mesh as polygons.
PolygonMesh to_polygon_mesh(const Mesh& mesh);

/// The same mesh as triangles, without colours; vertex and face order are kept. Positions that are moved in
/// are not copied. Throws MeshError naming the first face that is not a triangle.
Mesh to_triangle_mesh(PolygonMesh mesh);

}  // namespace orbitutte
