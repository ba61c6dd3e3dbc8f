// SPDX-License-Identifier: MIT
// The colours of tiles, in files and pictures alike.
#pragma once

#include <cstdint>

namespace orbitutte {

struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Rgb&) const = default;
};

/// The number of colours: enough for a tile with seven neighbours, across three pairs of sides and a mirror.
constexpr int palette_size = 8;

/// The colour with this number (modulo palette_size; sRGB), a shade darker for a mirrored tile. All sixteen
/// are distinct, even with 5 bits per channel.
Rgb tile_colour(int colour, bool mirrored);

}  // namespace orbitutte
