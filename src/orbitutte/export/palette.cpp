// SPDX-License-Identifier: MIT
// Soft colours that can be told apart with impaired colour vision, too: the "light" scheme of P. Tol, "Colour
// Schemes", SRON technical note 09-002 (2021), reordered for contrast between neighbours in the list.
#include "orbitutte/export/palette.h"

#include <array>

namespace orbitutte {

Rgb tile_colour(int colour, bool mirrored) {
  static constexpr std::array<Rgb, palette_size> palette = {{{119, 170, 221},
                                                             {238, 136, 102},
                                                             {238, 221, 136},
                                                             {68, 187, 153},
                                                             {255, 170, 187},
                                                             {153, 221, 255},
                                                             {187, 204, 51},
                                                             {170, 170, 0}}};
  const Rgb& light = palette[colour % palette_size];
  if (!mirrored) return light;
  const auto shade = [](std::uint8_t channel) { return static_cast<std::uint8_t>(channel * 3 / 4); };
  return {shade(light.red), shade(light.green), shade(light.blue)};
}

}  // namespace orbitutte
