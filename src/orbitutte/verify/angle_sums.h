// SPDX-License-Identifier: MIT
// The angles around vertices, what they may differ by from what they have to be, and the area: what one pass
// over the triangles gathers. Private to verify/.
#pragma once

#include <vector>

#include "orbitutte/orbifold/exact_positions.h"

namespace orbitutte {

/// The vertex of the surface that a cut vertex is a copy of; its own index for the middles of polygons, which
/// are copies of none (divide_from_middles).
inline int surface_vertex(const Embedding& triangles, int v) {
  return triangles.source_vertex[v] >= 0 ? triangles.source_vertex[v] : v;
}

struct TriangleSums {
  /// Of every triangle, exactly: is it positively oriented? The rounded area of a sliver does not tell.
  std::vector<char> positive;

  /// Of all triangles.
  double signed_area = 0;

  /// By surface_vertex: the sum of the signed angles of its corners, over all of its copies.
  std::vector<double> angle;
};

TriangleSums sum_over_triangles(const Embedding& triangles, const ExactPositions& positions);

/// By surface_vertex, of those marked in `is_asked`, otherwise 0: how much the rounding of positions may
/// change the sum of the angles, 16 * sum of (rounding of the ends)/length over the edges of its corners, an
/// inner edge counting twice. Infinite where an edge has no length.
std::vector<double> rounding_of_angles(const Embedding& triangles, const ExactPositions& positions,
                                       const std::vector<char>& is_asked);

/// By cut vertex, of those marked in `is_asked`, otherwise infinite: the chord of its shortest edge.
std::vector<double> shortest_edges(const Embedding& triangles, const ExactPositions& positions,
                                   const std::vector<char>& is_asked);

}  // namespace orbitutte
