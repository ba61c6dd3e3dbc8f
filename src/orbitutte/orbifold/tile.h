// SPDX-License-Identifier: MIT
// The basic tile of an orbifold and its gluing (appendix A).
#pragma once

#include <vector>

#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// A side of a tile: the geodesic p(s) = cs(s) start + sn(s) direction, 0 <= s <= length, the tile on its
/// left. A point of this side at arc length s is transform * (the point of side `partner` at length - s), or
/// at s if the transform is a rotary reflection. In both cases tiles lie on opposite sides of a glued side.
/// A side that is its own partner is a mirror, and stays as it is under the transform. A side without a
/// partner (-1) is held: its vertices stay where they are put.
struct TileSide {
  Space space;

  /// The corner where the side begins.
  Vector3 start;

  /// The unit tangent there.
  Vector3 direction;

  /// On the sphere at most pi, or 2 pi where the side is a whole circle.
  double length = 0;

  /// The marked point at the start: an index into Target::marks, or marks.size() for the end of a cut and
  /// where it branches.
  int mark = -1;

  /// Is the start any point of the mirror instead of a corner, or a vertex where the cut branches? Then the
  /// vertex is not held there.
  bool slides = false;
  int partner = -1;
  Isometry transform;

  bool held() const { return partner < 0; }
  Vector3 point(double s) const { return space.at(start, direction, s); }

  /// Does the partner run the other way?
  bool partner_reverses() const { return !transform.reverses_orientation(); }

  /// The line that the side lies on: line() . p is positive on the tile's side.
  Vector3 line() const { return Space::line(start, direction); }

  /// The unit tangent to the space that points away from the tile.
  Vector3 outward() const { return -space.normal(line()); }
};

/// The shortest geodesic between two points, on the sphere not antipodal, as a side without a partner.
TileSide geodesic_side(Space space, const Vector3& from, const Vector3& to, int mark);

/// A polygon of geodesics; corner k is where side k begins. Counterclockwise from outside. Without sides it
/// is the whole sphere.
struct Tile {
  std::vector<TileSide> sides;

  Space space() const { return sides.empty() ? Space::sphere() : sides.front().space; }

  /// A point in the middle. On the sphere it is the direction of the integral of the position over the tile,
  /// which is half the sum of length * pole over the sides. This also works for lunes and hemispheres, where
  /// the mean of the corners vanishes.
  Vector3 centroid() const;
};

/// The tile whose boundary meets the target's marks in the order `arrangement` (a permutation of their
/// indices; every other corner is a further image of one of them). A disk with a cone inside is cut from the
/// cone to the mirror. Then index marks.size() stands for the end of the cut, and comes second, after the
/// cone. A disk without marks has this index alone, for the point at which its boundary begins.
///
/// The tile lies in the target's canonical frame, which does not depend on the arrangement: mark 0 has an
/// image at (0, 0, 1). From there, mark 1 or a mirror has an image in the direction of x, so that the marks
/// of a closed surface are met counterclockwise. Tiles of the same target for different cuts are made of the
/// same points of the quotient. Throws ArgumentError if the arrangement is not such a permutation, or if the
/// tile is free: free_tile.h makes tiles from cuts.
Tile basic_tile(const Target& target, const std::vector<int>& arrangement);

/// An arrangement that basic_tile takes: the marks in their order.
std::vector<int> first_arrangement(const Target& target);

/// The same tile moved by an isometry that keeps orientations.
Tile moved_tile(const Tile& tile, const Isometry& isometry);

/// Is a side of the tile held? Then the tile lies where it was asked for, and may not be turned.
bool has_held_side(const Tile& tile);

/// Do rotations about (0, 0, 1) leave the gluing of all sides as it is, so that the embedding is fixed only
/// up to them?
bool is_free_to_rotate(const Tile& tile);

}  // namespace orbitutte
