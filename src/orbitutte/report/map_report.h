// SPDX-License-Identifier: MIT
// The file map.json: what is known of a map between two surfaces (docs/surface-maps.md).
#pragma once

#include <optional>
#include <string>

#include "orbitutte/map/composed_map.h"
#include "orbitutte/map/surface_map.h"

namespace orbitutte {

/// Is the map proved to be one to one: are both embeddings certified, and does the overlay hold? Nothing is
/// composed unless they are.
bool is_certified(const SurfaceMap& map, const std::optional<ComposedMap>& composed);

/// `timings` are those of the whole command. Ends with a line break.
std::string map_json(const SurfaceMap& map, const std::optional<ComposedMap>& composed,
                     const Timings& timings);

}  // namespace orbitutte
