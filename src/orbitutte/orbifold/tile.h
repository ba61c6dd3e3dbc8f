// SPDX-License-Identifier: MIT
// The basic tile of an orbifold and its gluing (appendix A).
#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "orbitutte/orbifold/signature.h"

namespace orbitutte {

/// A side of a tile: the great arc p(s) = cos(s) start + sin(s) direction, or the segment p(s) = start + s
/// direction of the plane z = 1, 0 <= s <= length, the tile on its left. A point of this side at arc length s
/// is transform * (the point of side `partner` at length - s), or at s where the transform is a rotary
/// reflection: tiles lie on opposite sides of a glued side in both cases. A side that is its own partner is a
/// mirror, and stays as it is under the transform. A side without a partner (-1) is held: its vertices stay
/// where they are put.
struct TileSide {
  Vector3 start;        ///< the corner where the side begins
  Vector3 direction;    ///< unit tangent there
  double length = 0;    ///< on the sphere: radians, at most pi
  int mark = -1;        ///< the marked point at the start, an index into Orbifold::marks or one behind
  bool slides = false;  ///< the start is no corner but any point of the mirror: its vertex is not held there
  int partner = -1;
  Matrix3 transform = Matrix3::Identity();
  Geometry geometry = Geometry::spherical;

  bool held() const { return partner < 0; }
  Vector3 point(double s) const;

  /// Does the partner run the other way?
  bool partner_reverses() const { return transform.determinant() > 0; }

  /// The unit tangent to the surface that points away from the tile.
  Vector3 outward() const {
    return geometry == Geometry::spherical ? Vector3(-pole()) : Vector3(direction.y(), -direction.x(), 0);
  }

  Vector3 pole() const {
    return start.cross(direction);
  }  ///< the unit normal of the arc's plane, towards the tile; in the plane, pole . p = 0 is the side's line
};

/// The shorter great arc between two points of the sphere that are not antipodal, as a side without a
/// partner.
TileSide great_arc(const Vector3& from, const Vector3& to, int mark);

/// A spherical polygon; corner k is where side k begins. Counterclockwise from outside.
struct Tile {
  std::vector<TileSide> sides;

  Geometry geometry() const { return sides.front().geometry; }

  /// On the sphere: the direction of the integral of the position over the tile: half the sum of length *
  /// pole over the sides, which holds for lunes and hemispheres too, where the mean of the corners vanishes.
  Vector3 centroid() const;
};

/// The tile whose boundary meets the orbifold's marks in the order `arrangement` (a permutation of their
/// indices; every other corner is a further image of one of them). A disk with a cone inside is cut from it
/// to the mirror: there, index marks.size() stands for the end of the cut, and comes second, after the cone.
/// Throws ArgumentError where the arrangement is no such permutation.
Tile basic_tile(const Orbifold& orbifold, const std::vector<int>& arrangement);

/// The same tile turned by a rotation.
Tile rotated(const Tile& tile, const Matrix3& rotation);

/// True where a side is held, so that the tile lies where it was asked for and may not be turned.
bool stays_put(const Tile& tile);

/// True where a rotation about an axis changes no side's gluing, so that the embedding is fixed only up to
/// it; then `axis` is that direction.
bool free_rotation_axis(const Tile& tile, Vector3& axis);

}  // namespace orbitutte
