// SPDX-License-Identifier: MIT
// Polygons divided into triangles, with which everything computes that asks for triangles. Their edges are
// those of the polygons alone: a diagonal has no weight, no path runs along it, and no file lists it.
#pragma once

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

/// How polygons are divided: face f of d corners becomes d - 2 triangles, which follow those of face f - 1.
struct Triangulation {
  Faces corners;                ///< T x 3, counterclockwise: indices into Polygons::corners
  std::vector<int> face_start;  ///< Polygons::start

  /// The polygons of which `triangles` (T x 3) are the division, on the vertices that those name. Where
  /// triangles are turned over (T: second and third vertex exchanged; or empty), their polygon is, too.
  Polygons polygons(const Faces& triangles, const std::vector<char>& turned = {}) const;
};

/// Has every face three corners?
bool is_triangle_mesh(const PolygonMesh& mesh);

/// Cuts off a polygon's corners one after the other, always the one whose triangle is nearest to an
/// equilateral one (the largest area over the sum of its squared sides, negative where the polygon bends
/// inwards), until four corners are left, and these by the diagonal whose worse triangle is the better. O(c
/// log c) for c corners. The mesh is expected to have passed `inspect`.
Triangulation triangulate(const PolygonMesh& mesh);

/// Every polygon in triangles from its first corner: what convex ones need.
Triangulation fan(const Polygons& polygons);

/// The triangles (T x 3) on vertices: those of `corners` (Polygons::corners).
Faces on_vertices(const Triangulation& triangulation, const std::vector<int>& corners);

/// The half-edges of the triangles and the edges of the polygons, in O(c log c). Half-edges of diagonals have
/// the opposite one in the same polygon, and the edge -1.
Connectivity connect(const PolygonMesh& mesh, const Triangulation& triangulation);

}  // namespace orbitutte
