// SPDX-License-Identifier: MIT
// The overlay in triangles, as what draws and bakes needs it: each piece in one triangle of A and in one of
// B, and what is given on B at its corners.
#pragma once

#include <vector>

#include "orbitutte/map/overlay.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// A point's coordinates in a triangle of the embedding that holds it: its own, or one that has the point on
/// its boundary. They are not negative and have the sum 1. Throws ArgumentError if the triangle does not hold
/// the point.
Vector3 coordinates_in(const Embedding& embedding, const SurfacePoints& points, int point, int triangle);

/// The pieces: overlay_triangles, on which A, B and what lies between them are linear.
struct OverlayPieces {
  /// T x 3, vertices of the overlay.
  Triangles triangles;

  /// T: the triangles of A and of B that hold each.
  std::vector<int> on_a, on_b;

  int count() const { return static_cast<int>(triangles.rows()); }
};

OverlayPieces overlay_pieces(const Overlay& overlay);

/// The colours of a surface's vertices (n x 3, sRGB, 0 .. 1): its own, or else their positions in its box as
/// red, green and blue.
Points shown_colours(const Surface& surface);

}  // namespace orbitutte
