// SPDX-License-Identifier: MIT
// Barycentric coordinates in a spherical triangle, with which an embedding is a map of points and not of
// vertices alone.
#pragma once

#include <array>

#include "orbitutte/types.h"

namespace orbitutte {

/// A triangle of three unit vectors, counterclockwise from outside.
using SphericalCorners = std::array<Vector3, 3>;

/// The unit vector that the coordinates stand for: the flat triangle's point, seen from the centre,
///
///     (l_0 a_0 + l_1 a_1 + l_2 a_2) / |l_0 a_0 + l_1 a_1 + l_2 a_2|.
///
/// On an edge it depends on the edge's ends alone, and an orthogonal map of the corners maps it along:
/// triangles agree on common edges and across seams.
Vector3 spherical_point(const SphericalCorners& corners, const Vector3& coordinates);

/// Is the unit vector in the triangle, its edges and corners included? Exact on the numbers as stored.
bool contains(const SphericalCorners& corners, const Vector3& point);

/// The coordinates of a point in the triangle: l_0 : l_1 : l_2 = det[p a_1 a_2] : det[a_0 p a_2] : det[a_0
/// a_1 p], not negative, with the sum 1. spherical_point takes them back to the point, up to rounding.
Vector3 spherical_coordinates(const SphericalCorners& corners, const Vector3& point);

/// The coordinates of the point of the triangle's edges that is nearest to `point`, up to rounding, where
/// both are near to each other.
Vector3 nearest_on_edges(const SphericalCorners& corners, const Vector3& point);

}  // namespace orbitutte
