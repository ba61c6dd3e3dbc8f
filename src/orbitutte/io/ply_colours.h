// SPDX-License-Identifier: MIT
// Colours of vertices in PLY: the properties red, green and blue.
#pragma once

#include <array>
#include <optional>

#include "orbitutte/io/ply.h"

namespace orbitutte {

/// Red, green, blue.
using PlyChannels = std::array<const PlyProperty*, 3>;

/// The channels of an element; none where it has none of them. Throws MeshError where it has one or two of
/// them, or a list.
std::optional<PlyChannels> find_channels(const PlyElement& vertex);

/// A channel's value as 0 .. 1: integers are bytes, of which 255 is full. Throws MeshError naming the vertex
/// where the value is out of range.
double channel_value(const PlyProperty& channel, double value, std::size_t vertex);

}  // namespace orbitutte
