// SPDX-License-Identifier: MIT
// What a surface is mapped onto: an orbifold S^2/G or R^2/G, a surface with cones of any angles, or a fixed
// spherical polygon.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/geometry/space.h"
#include "orbitutte/names.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// A Conway symbol that has been read: rotation orders before the first star or cross, corner orders after
/// the star.
struct ConwaySymbol {
  std::vector<int> rotations;
  std::vector<int> corners;
  bool star = false;
  bool cross = false;

  /// One character per order if all are single digits, otherwise commas; `x` for the cross; `1` if there is
  /// nothing.
  std::string text() const;
};

/// The signature of fixed boundaries, which have no symbol of Conway's: theorem 1, see polygon.h.
inline const std::string polygon_signature = "polygon";

/// The signatures of surfaces with cones of any angles, closed ones and disks with corners: cone_target.h.
inline const std::string cones_signature = "cones", mirrored_cones_signature = "*cones";

enum class ConeKind { rotation, corner, fixed };

/// Its names.
template <>
struct NameTable<ConeKind> {
  static constexpr NamedValue<ConeKind> rows[] = {
      {ConeKind::rotation, "rotation"}, {ConeKind::corner, "corner"}, {ConeKind::fixed, "fixed"}};
};

/// A marked point of the target.
struct Mark {
  /// What the angles around it add up to, radians: 2 pi/n at a cone of order n, pi/n at a corner; 0 if the
  /// point is held and its angle is not asked for.
  double angle = 0;
  ConeKind kind = ConeKind::rotation;

  /// The mark of an order; a fixed one has none.
  static Mark of_order(int order, ConeKind kind);

  /// n if the angle is 2 pi/n (rotation) or pi/n (corner), 1 if the mark is fixed, otherwise 0.
  int order() const;
};

/// What an embedding aims at. parse_orbifold, cone_target and polygon_target make targets.
struct Target {
  /// The canonical text, with the orders in the arrangement that was given.
  std::string signature;
  ConwaySymbol symbol;
  Space space;

  /// What the mesh must be.
  Topology topology = Topology::sphere;

  /// In the order in which vertices are marked.
  std::vector<Mark> marks;

  /// The first `inner_marks` marks lie inside the surface, the others on its boundary.
  int inner_marks = 0;

  /// |G|; 0 if it is infinite.
  int group_order = 1;

  /// The corners of a fixed polygon, one for each mark; otherwise empty (polygon.h).
  std::vector<PolygonCorner> corners;

  /// Is the boundary held on a polygon?
  bool is_polygon() const { return !corners.empty(); }

  /// Do rotations about (0, 0, 1) change nothing about the target? NN, N* and Nx fix a map only up to such a
  /// rotation.
  bool is_free_to_rotate = false;

  /// Do the angles leave the shape of the tile open? Then it is found together with the map, and is the
  /// surface's own: the one for which the map is conformal (free_tile.h).
  bool has_free_tile = false;

  /// Is it open in a curved space, where it takes a search? In the plane one linear solve finds it.
  bool has_curved_free_tile() const { return has_free_tile && space != Space::plane(); }
};

}  // namespace orbitutte
