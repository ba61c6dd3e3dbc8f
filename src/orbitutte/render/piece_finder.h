// SPDX-License-Identifier: MIT
// Points of surface A in the pieces of an overlay, for pictures that see A's own triangles.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/export/overlay_pieces.h"

namespace orbitutte {

/// A piece of the overlay, and coordinates on its corners.
struct PiecePoint {
  int piece = -1;
  Vector3 weights = Vector3::Zero();
};

class PieceFinder {
 public:
  /// In time and memory linear in the number of pieces. Throws as coordinates_in does.
  PieceFinder(const Overlay& overlay, const OverlayPieces& pieces, const Embedding& a);

  /// The piece of a triangle of A that holds a point of it, or is nearest to it; -1 if the triangle has none
  /// with an area.
  PiecePoint find(int triangle, const Vector3& coordinates) const;

 private:
  /// By triangle of A: its pieces are pieces_[start_[t]] .. pieces_[start_[t + 1] - 1].
  std::vector<int> start_, pieces_;

  /// By piece: the coordinates of its corners in the triangle of A.
  std::vector<std::array<Vector3, 3>> corners_;
};

}  // namespace orbitutte
