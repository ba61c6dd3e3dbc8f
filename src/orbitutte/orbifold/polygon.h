// SPDX-License-Identifier: MIT
// Fixed boundaries (theorem 1): a disk is mapped onto a convex spherical polygon, with its boundary held on
// the polygon's sides. No symmetry is left, so the polygon acts as an orbifold whose group is the identity.
#pragma once

#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

struct Tile;

/// The polygon with these corners, in the order of the vertices along the mesh's boundary, counterclockwise
/// as seen from outside. Its marks are the corners, which are fixed. There must be three or more different
/// vertices at unit vectors (to 1e-12), and neighbours must be neither equal nor opposite. The polygon must
/// be convex (straight corners are allowed), lie in an open hemisphere and go around once. Throws MeshError
/// naming the vertex otherwise.
Target polygon_target(const std::vector<PolygonCorner>& corners);

/// The vertices of a polygon's corners, to be marked.
std::vector<int> corner_vertices(const Target& polygon);

/// The polygon as a tile whose sides are held. Throws MeshError naming a vertex if the boundary meets the
/// corners in another order (`arrangement`, as in basic_tile) than that of the polygon.
Tile polygon_tile(const std::vector<PolygonCorner>& corners, const std::vector<int>& arrangement);

/// The target of an embedding that was read: the one that the signature names, with the angles of the cones
/// if they are no part of it, or the polygon with the fixed cones at their positions. Throws ArgumentError
/// and MeshError if there is no such target.
Target read_target(const std::string& signature, const std::vector<ConeCopies>& cones,
                   const Points& positions);

/// The area of the target: 4 pi/|G|; in the plane, the tile's; for a polygon, the sum of its interior angles
/// less (n - 2) pi; free_tile_area.
double target_area(const Target& target);

}  // namespace orbitutte
