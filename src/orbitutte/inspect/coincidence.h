// SPDX-License-Identifier: MIT
// Vertices of the boundary at the same point. They show that a surface was not welded together, for instance
// along the seams of a texture.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// Two vertices of the boundary that no edge of the boundary joins.
struct Coincidence {
  /// Vertex < other.
  int vertex = -1, other = -1;
  /// 0: at the same point.
  double distance = 0;
};

/// The first two vertices at the same point, or, if there are none, nearly so: a millionth of the boundary's
/// size apart. `boundary` has its edges, in any order. Positions that are not finite are left out. O(n log
/// n).
std::optional<Coincidence> find_coincidence(const Points& V, const std::vector<std::array<int, 2>>& boundary);

/// "vertices 2 and 14 are at the same point: weld such vertices first"; empty if there are none.
std::string welding_advice(const std::optional<Coincidence>& coincidence);

/// " (the sentence)", or nothing if it is empty.
std::string in_brackets(const std::string& sentence);

}  // namespace orbitutte
