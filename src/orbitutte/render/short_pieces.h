// SPDX-License-Identifier: MIT
// Long, thin triangles in short pieces: the boxes around whole ones, as around a vertex of many edges, would
// all overlap, and rays would have to try them all.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// A triangle, or a piece of one.
struct Piece {
  /// The triangle that it is a piece of.
  int face = -1;

  /// Rows of Pieces::positions.
  std::array<int, 3> corners;

  /// (u, v) of its corners in the triangle (1 - u - v) a + u b + v c.
  std::array<Eigen::Vector2f, 3> places;

  /// Where a place in the piece lies in the triangle.
  Eigen::Vector2f place_in_face(float u, float v) const {
    return (1 - u - v) * places[0] + u * places[1] + v * places[2];
  }
};

struct Pieces {
  /// The vertices, followed by the ends of pieces on edges.
  Points positions;
  std::vector<Piece> pieces;
};

/// Triangles that are much longer than wide are divided across; each edge in the same points for both of its
/// triangles, so that no gap opens between them. V: n x 3; F: m x 3, an edge-manifold mesh. Fewer than
/// 200,000 pieces are added.
Pieces short_pieces(const Points& V, const Triangles& F);

}  // namespace orbitutte
