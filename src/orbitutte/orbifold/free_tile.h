// SPDX-License-Identifier: MIT
// Tiles whose shape is free: polygons whose sides follow a cut along a tree, glued by products of rotations
// about the cones.
#pragma once

#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/orbifold/moduli.h"
#include "orbitutte/orbifold/tile.h"

namespace orbitutte {

/// The tile of a surface that is cut along a tree (cut_along_tree), from positions of its vertices.
///
/// Let R_k be the rotation about the cone that the boundary of the cut mesh meets as the k-th, by its angle
/// and about the copy that is met first. What is met between both banks of a side is a branch of the tree,
/// with the cones i .. j, and the gluing of the side is R_i ... R_j. Its corners are the marks, which are
/// held, and the vertices where the cut branches or ends, which are not. The mirrors of a disk lead from
/// corner to corner (Moduli). In the plane, where linear conditions are wanted, their directions follow from
/// the angles, the first being that of x, and every mirror passes through the mark where it begins.
///
/// positions: n x 3, of the input vertices, of which those at corners count. Any positions make gluings;
/// closing_defects tells, in the plane, whether they make a tile, and Moduli in other spaces.
Tile tile_through(const Target& target, const CutMesh& cut, const Points& positions);

/// Positions of all cut vertices (n_cut x 3) from those of the input vertices (n x 3) on the tile through
/// them. In the hyperbolic plane a copy may be far nearer to (0, 0, 1) than the isometry that makes it is to
/// the identity: products have more digits than doubles, and each copy is rounded once.
Points spread_on_free_tile(const Target& target, const CutMesh& cut, const Points& positions);

/// What keeps the positions of the marks from making a tile in the plane: linear in them, and zero if they
/// do. On a sphere, the two coordinates of the translation that is the product of all rotations, which has to
/// be the identity; on a disk, for each mark on the boundary, its distance from the mirror that leads there.
std::vector<double> closing_defects(const Target& target, const CutMesh& cut, const Points& positions);

/// Where the first mark of a sphere has to lie so that the product of all rotations is the identity, if their
/// angles allow that: near its position, the point that the product of the others leaves where it is. In the
/// hyperbolic plane, positions that close up to the rounding of doubles may be off by a million times that.
/// The mirrors of a disk close wherever its marks lie: then it is its position.
Vector3 closing_position(const Target& target, const CutMesh& cut, const Points& positions);

/// The shapes of tiles in the plane: positions of the marks without closing defects, translations left out.
struct TileShapes {
  /// A basis, one shape a column: the complex numbers x + iy of the marks, in the order of CutMesh::marks.
  Eigen::MatrixXcd basis;

  /// Are the shapes turned by a right angle, i times a column, shapes as well? They are if there is no
  /// mirror.
  bool may_be_turned = false;
};

TileShapes tile_shapes(const Target& target, const CutMesh& cut);

/// The marks where a shape has them, all other input vertices at (0, 0, 1): n x 3.
Points positions_of_marks(const CutMesh& cut, const Eigen::VectorXcd& shape);

/// The marked vertices in the order in which the boundary of the cut mesh meets them, as Moduli numbers them.
/// A disk without corners has the vertex where its boundary begins besides.
std::vector<int> cones_as_met(const CutMesh& cut);

/// The shapes of a curved target. Throws ArgumentError if there are none (Moduli).
Moduli moduli_of(const Target& target, const CutMesh& cut);

/// Throws ArgumentError if the target's tile is curved, its shape is free, and the angles leave none.
void require_shapes(const Target& target);

/// Of a map (n x 3) whose first mark lies at (0, 0, 1), a point that has the direction which x has in the
/// canonical frame: the second mark. For 2222, whose group has many images of it, the nearest of these, or
/// the one opposite to it, so that it does not depend on the cut.
Vector3 point_towards_x(const Target& target, const CutMesh& cut, const Points& positions);

/// A tile of some shape: in the plane, the linear parts of its gluings are those of all others; a curved one
/// is made from a polygon with an inscribed circle. Throws as moduli_of does.
Tile any_tile(const Target& target, const CutMesh& cut);

}  // namespace orbitutte
