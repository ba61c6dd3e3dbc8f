// SPDX-License-Identifier: MIT
// A sheet of pictures of a map between two surfaces (docs/surface-maps.md).
#pragma once

#include <optional>
#include <string>

#include "orbitutte/map/composed_map.h"
#include "orbitutte/map/surface_map.h"

namespace orbitutte {

/// What is shown. `map` is of the surfaces a and b, and `composed` of all three.
struct MapSheet {
  const Surface &a, &b;
  const SurfaceMap& map;
  const ComposedMap& composed;

  /// Names of both surfaces.
  std::string name_of_a, name_of_b;

  /// The direction from A towards the viewer, and what points up; B is seen from where it corresponds.
  std::optional<Vector3> view = {}, up = {};

  /// Of the picture, in pixels, 300 .. 10,000.
  int width = 2400;
};

/// The bytes of a PNG: both surfaces with their landmarks, B in its colours (or, if it has none, coloured by
/// position) and a checkerboard in space, both carried to A, and the map's change of area and symmetric
/// Dirichlet energy on A. Throws ArgumentError if the width is out of range.
std::string map_sheet_png(const MapSheet& sheet);

/// Writes it. The file appears whole or not at all. Throws ArgumentError for another ending than .png, and
/// FileError.
void write_map_sheet(const std::string& path, const MapSheet& sheet);

}  // namespace orbitutte
