// SPDX-License-Identifier: MIT
// A surface as one value, whatever its faces were in the file. Everything after the readers takes it.
#pragma once

#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// Vertices, faces of any size, their triangles and how these are connected. make_surface
/// (inspect/recognition.h) makes it once and judges the mesh; it is const from then on.
struct Surface {
  /// n x 3 positions.
  Points V;
  /// T x 3: the faces in their order, with larger faces divided into triangles.
  Triangles triangles;
  /// The half-edges of the triangles, and the edges of the faces alone.
  Connectivity connectivity;
  /// The faces, if some have more than three corners; none if all are triangles.
  Polygons polygons;
  /// T x 3: the triangles as indices into polygons.corners (triangulate); none if all faces are triangles.
  Triangles division;
  Topology topology = Topology::other;
  int unreferenced_vertices = 0;
  /// As Inspection counts them.
  int zero_area_faces = 0;
  /// n x 3, the colours of the vertices in sRGB, 0 .. 1; empty if the mesh has no colours.
  Points colours = Points(0, 3);

  bool has_polygons() const { return polygons.count() > 0; }
  int vertex_count() const { return static_cast<int>(V.rows()); }
  int triangle_count() const { return static_cast<int>(triangles.rows()); }

  /// The area of a triangle.
  double area(Eigen::Index triangle) const;

  /// The area of all triangles.
  double total_area() const;

  /// n: a third of the area of the triangles around each vertex.
  Eigen::VectorXd vertex_areas() const;

  /// n: 1 for the vertices on the boundary.
  std::vector<char> boundary_vertices() const;

  /// The faces as they were given.
  FaceView faces() const { return has_polygons() ? FaceView(polygons) : FaceView(triangles); }

  /// The polygons that the triangles make up on other vertices, such as those of a cut mesh; none if all
  /// faces are triangles. cut: T x 3, the triangles there. turned: T, or empty; if a triangle is turned over
  /// (its second and third vertex exchanged), its polygon is, too.
  Polygons polygons_on(const Triangles& cut, const std::vector<char>& turned = {}) const;
};

/// Unit normals of the vertices (n x 3), each the mean over its triangles by their areas; (0, 0, 1) where
/// there is none.
Points vertex_normals(const Points& V, const Triangles& F);

}  // namespace orbitutte
