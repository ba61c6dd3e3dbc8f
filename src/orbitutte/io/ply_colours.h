// SPDX-License-Identifier: MIT
// Colours of vertices in PLY: the properties red, green and blue.
#pragma once

#include <array>

#include "orbitutte/io/ply.h"
#include "orbitutte/io/vertex_colours.h"

namespace orbitutte {

/// Red, green and blue of an element. Either all three are there or none.
struct PlyChannels {
  std::array<const PlyProperty*, 3> channel = {};
  /// Why none is there although the element has one of them; otherwise empty.
  std::string problem;

  bool are_there() const { return channel[0] != nullptr; }
};

PlyChannels find_channels(const PlyElement& vertex);

/// The colours from the values of the channels, n x 3: bytes if all three have integer types.
VertexColours colours_of_channels(const PlyChannels& channels, const Points& values);

}  // namespace orbitutte
