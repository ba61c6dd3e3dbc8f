// SPDX-License-Identifier: MIT
// Polygons divided into triangles, for all computations that need triangles. Their edges are those of the
// polygons alone: a diagonal has no weight, no path runs along it, and no file lists it. A division is T x
// 3, counterclockwise: indices into the polygons' corners. Face f of d corners becomes d - 2 triangles,
// which follow those of face f - 1.
#pragma once

#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

/// Does every face have three corners?
bool is_triangle_mesh(const PolygonMesh& mesh);

/// Cuts off a polygon's corners one after the other, always the one whose triangle is nearest to an
/// equilateral one (the largest area over the sum of its squared sides, negative where the polygon bends
/// inwards). The last four corners are divided by the diagonal whose worse triangle is the better. O(c log
/// c) for c corners. The mesh is expected to have passed `inspect`.
Triangles triangulate(const PolygonMesh& mesh);

/// Divides every polygon into triangles from its first corner, which is enough for convex polygons.
Triangles fan_triangles(const Polygons& polygons);

/// The triangles (T x 3) on vertices instead of corners. corners: Polygons::corners.
Triangles triangles_on_vertices(const Triangles& division, const std::vector<int>& corners);

/// The half-edges of the triangles and the edges of the polygons, in O(c log c). Half-edges of diagonals have
/// the opposite one in the same polygon, and the edge -1.
Connectivity connectivity_of(const PolygonMesh& mesh, const Triangles& division);

}  // namespace orbitutte
