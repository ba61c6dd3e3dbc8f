// SPDX-License-Identifier: MIT
// Fixed boundaries (theorem 1): a disk onto a convex spherical polygon, its boundary held on the polygon's
// sides. No symmetry is left, so the polygon takes the place of an orbifold whose group is the identity.
#pragma once

#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/tile.h"

namespace orbitutte {

/// The polygon with these corners, counterclockwise seen from outside, as the vertices follow each other
/// along the mesh's boundary; its marks are the corners, fixed. Throws MeshError, naming the vertex, unless
/// they are three or more different vertices at unit vectors (to 1e-12), neighbours neither equal nor
/// opposite, and the polygon is convex (straight corners are allowed), lies in an open hemisphere and goes
/// around once.
Target polygon_target(const std::vector<PolygonCorner>& corners);

/// The vertices of a polygon's corners, to be marked.
std::vector<int> corner_vertices(const Target& polygon);

/// The polygon as a tile whose sides are held. Throws MeshError naming a vertex where the boundary meets the
/// corners in another order (`arrangement`, as in basic_tile) than the polygon has them.
Tile polygon_tile(const std::vector<PolygonCorner>& corners, const std::vector<int>& arrangement);

/// What cones and positions say that the target is: that of the signature, or for a polygon the one of its
/// fixed cones and where they are. Throws ArgumentError and MeshError if that is nothing.
Target read_target(const std::string& signature, const std::vector<ConeCopies>& cones,
                   const Points& positions);

/// 4 pi/|G|; in the plane the tile's; of a polygon the sum of its interior angles less (n - 2) pi.
double target_area(const Target& target);

}  // namespace orbitutte
