// SPDX-License-Identifier: MIT
// The one table of families: symbol, space, tile and gluing of each (appendix A). To add a family, add a row.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/tile.h"

namespace orbitutte {

/// The part of a cell of the plane's lattice that a tile fills, from the cell's lower left corner.
struct PartOfCell {
  /// Shares of both sides of the cell; 0 if the tile is no such part.
  double across = 0, up = 0;

  /// The order of the rotation about that corner.
  int order_at_corner = 0;

  bool is_known() const { return order_at_corner > 0; }
};

/// One row of the table. A family is known by its symbol with the orders sorted, where 0 stands for the free
/// order N.
struct Family {
  /// "22N"
  std::string name;

  /// "2N", or "infinite"
  std::string group_order;

  /// For people.
  std::string marked_points;

  /// Sorted orders, 0 for N.
  ConwaySymbol pattern;
  Topology topology;

  /// Makes the tile of a target of this family in its canonical frame, as basic_tile describes it. Null if
  /// the shape of the tile is free (Target::has_free_tile).
  Tile (*tile)(const Target& target, const std::vector<int>& arrangement);

  /// The group belongs to that of the reflections in the sides of the triangle whose corner k has the angle
  /// pi/n with the k-th of these orders (canonical_triangle). Null if the shape of the tile is free.
  std::vector<int> (*chamber)(const Target& target);

  /// Is the corner of the tile after the first mark, or its only corner, any point of the mirror: the end of
  /// the cut?
  bool cut_to_mirror = false;

  /// The smallest N.
  int smallest_order = 2;

  /// Is z -> z^N, in the stereographic chart of the canonical frame, the quotient by the rotations of the
  /// group?
  bool has_one_axis = false;

  /// In the plane.
  PartOfCell part_of_cell = {};
};

const std::vector<Family>& family_table();

/// The row that the symbol belongs to, or null.
const Family* find_family(const ConwaySymbol& symbol);

/// Is the symbol 222 or *222?
bool is_of_three_half_turns(const ConwaySymbol& symbol);

}  // namespace orbitutte
