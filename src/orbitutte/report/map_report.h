// SPDX-License-Identifier: MIT
// The file map.json: what is known of a map between two surfaces (docs/surface-maps.md).
#pragma once

#include <optional>
#include <string>

#include "orbitutte/map/map_distortion.h"
#include "orbitutte/map/overlay_certificate.h"
#include "orbitutte/map/surface_map.h"

namespace orbitutte {

/// What is known of a map beyond its embeddings: of the overlay, which only certified embeddings have.
struct MapFigures {
  int overlay_vertices = 0, overlay_faces = 0;
  OverlayCertificate certificate;
  MapDistortion distortion;

  /// The largest distance between a landmark's image and its partner, in square roots of B's area.
  double landmark_error = 0;
};

/// Is the map proved to be one to one: both embeddings are, and the overlay holds?
bool is_certified(const SurfaceMap& map, const std::optional<MapFigures>& figures);

/// `timings` are those of the whole command. Ends with a line break.
std::string map_json(const SurfaceMap& map, const std::optional<MapFigures>& figures, const Timings& timings);

}  // namespace orbitutte
