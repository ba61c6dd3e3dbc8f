// SPDX-License-Identifier: MIT
// A map between two surfaces as one HTML file that needs nothing else (docs/surface-maps.md).
#pragma once

#include <string>

#include "orbitutte/map/composed_map.h"
#include "orbitutte/map/surface_map.h"

namespace orbitutte {

/// The subject of the page: `map` is of the surfaces a and b, `composed` of all three.
struct MapPageSubject {
  const Surface &a, &b;
  const SurfaceMap& map;
  const ComposedMap& composed;

  /// Names of both surfaces.
  std::string name_of_a, name_of_b;
};

/// The page: both surfaces beside each other, turned together, where the point of one under the pointer shows
/// on the other; B's colours, a checkerboard of B and the distortion on both; the numbers. Whatever is
/// pointed at is taken in the overlay's triangles, on which the page is linear. Contains everything that it
/// shows, and a content security policy keeps it from loading anything. Without the interactive view
/// (has_interactive_view), it has the numbers alone. Throws ArgumentError if the overlay has more than four
/// million triangles.
std::string map_page(const MapPageSubject& subject);

/// What its script draws, as JSON; viewer/src/linked_scene.js reads it.
///
/// - `vertices`, `faces`: of the overlay, in triangles; `indices`: base64 of uint32;
/// - of its vertices, base64 of little-endian numbers: `a` and `b` (uint16 x 3 within a cube of the box's
///   longest edge, whose low corner and edge are `a_box` and `b_box`; b is turned by the transpose of `turn`,
///   row by row, so that both surfaces look alike), `a_normal` and `b_normal` (int8 x 3, times 127), `colour`
///   (uint8 x 3, sRGB, of B), `area` and `energy` (uint16 within `area_range`, `energy_range`: log2 of the
///   change of area, and the symmetric Dirichlet energy; averages over the triangles around, by their area on
///   A), `a_vertex` and `b_vertex` (int32: input vertices that lie there, or -1);
/// - `has_colours`: whether the colours are B's own, not its positions;
/// - `landmarks`: `a`, `b` (input vertices), `at` (vertex of the overlay), `colour`;
/// - `scales`: `area` and `energy`, as page_scene has them; `plain`, `ink`: colours.
///
/// Holds no `<`.
std::string map_scene(const MapPageSubject& subject);

}  // namespace orbitutte
