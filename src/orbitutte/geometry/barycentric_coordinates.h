// SPDX-License-Identifier: MIT
// Barycentric coordinates in a geodesic triangle, with which an embedding is a map of points and not of
// vertices alone.
#pragma once

#include <array>

#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// The corners of a triangle, counterclockwise from outside.
using TriangleCorners = std::array<Vector3, 3>;

/// The point that the coordinates stand for: the flat triangle's point, retracted to the space; on the sphere
///
///     (l_0 a_0 + l_1 a_1 + l_2 a_2) / |l_0 a_0 + l_1 a_1 + l_2 a_2|.
///
/// On an edge it depends on the edge's ends alone, and an isometry of the corners maps it along: triangles
/// agree on common edges and across seams.
Vector3 barycentric_point(Space space, const TriangleCorners& corners, const Vector3& coordinates);

/// Is the point in the triangle, its edges and corners included? Exact on the numbers as stored.
bool triangle_contains(const TriangleCorners& corners, const Vector3& point);

/// The coordinates of a point in the triangle: l_0 : l_1 : l_2 = det[p a_1 a_2] : det[a_0 p a_2] : det[a_0
/// a_1 p], not negative, with the sum 1. barycentric_point takes them back to the point, up to rounding.
Vector3 barycentric_coordinates(Space space, const TriangleCorners& corners, const Vector3& point);

/// The coordinates of the point of the triangle's edges that is nearest to `point`, up to rounding, if both
/// are near to each other.
Vector3 nearest_on_edges(Space space, const TriangleCorners& corners, const Vector3& point);

/// How far the triangle's points are from the flat triangle with the same corners, at the most.
double triangle_bulge(Space space, const TriangleCorners& corners);

}  // namespace orbitutte
