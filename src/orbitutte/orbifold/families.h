// SPDX-License-Identifier: MIT
// The one table of families: symbol, tile and gluing of each (appendix A).
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/tile.h"

namespace orbitutte {

/// One row of the table. A family is known by its symbol with the orders sorted, where 0 stands for the free
/// order N.
struct Family {
  std::string name;           ///< "22N"
  std::string group_order;    ///< "2N"
  std::string marked_points;  ///< for people
  ConwaySymbol pattern;       ///< sorted orders, 0 for N
  Topology topology;
  /// From the orders and the marks as the boundary meets them.
  Tile (*tile)(const std::vector<int>& orders, const std::vector<int>& marks);
  bool cut_to_mirror = false;  ///< the second corner of the tile is the end of the cut on the mirror
  int smallest_order = 2;      ///< that N may be
  Geometry geometry = Geometry::spherical;
};

const std::vector<Family>& family_table();

/// The row of this geometry that the symbol belongs to, or null.
const Family* find_family(const ConwaySymbol& symbol, Geometry geometry = Geometry::spherical);

}  // namespace orbitutte
