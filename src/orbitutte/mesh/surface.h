// SPDX-License-Identifier: MIT
// A surface as one value, whatever its faces were in the file: what everything behind the readers takes.
#pragma once

#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// Vertices, faces of any size, their triangles and how these hang together. Made once, by make_surface
/// (inspect/recognition.h), which judges the mesh; const from then on.
struct Surface {
  Points V;                   ///< n x 3
  Faces triangles;            ///< T x 3: its faces in their order, larger ones divided into triangles
  Connectivity connectivity;  ///< the half-edges of the triangles, and the edges of the faces alone
  Polygons polygons;  ///< its faces, where some have more than three corners; none where all are triangles
  Faces division;     ///< T x 3: the triangles as indices into polygons.corners (triangulate); none likewise
  Topology topology = Topology::other;
  int unreferenced_vertices = 0;
  int zero_area_faces = 0;        ///< as Inspection counts them
  Points colours = Points(0, 3);  ///< n x 3, of the vertices: sRGB, 0 .. 1; or none

  bool has_polygons() const { return polygons.count() > 0; }
  int vertex_count() const { return static_cast<int>(V.rows()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }

  /// The faces as they were given.
  FaceView faces() const { return has_polygons() ? FaceView(polygons) : FaceView(triangles); }

  /// The polygons that the triangles make up on other vertices, such as those of a cut mesh. cut: T x 3, the
  /// triangles there. Where one is turned over (T: second and third vertex exchanged; or empty), its polygon
  /// is, too. None where all faces are triangles.
  Polygons polygons_on(const Faces& cut, const std::vector<char>& turned = {}) const;
};

}  // namespace orbitutte
