// SPDX-License-Identifier: MIT
// Lists of colours that are told apart with impaired colour vision too: P. Tol, "Colour Schemes", SRON
// technical note 09-002 (2021). Tiles have the "light" scheme, reordered for contrast between neighbours in
// the list. Scales are straight lines in Oklab.
#include "orbitutte/export/palette.h"

#include <array>
#include <cmath>

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

Rgb cone_colour(int cone) {
  static constexpr std::array<Rgb, 12> colours = {{{204, 51, 17},
                                                   {0, 136, 96},
                                                   {136, 46, 114},
                                                   {0, 92, 160},
                                                   {176, 112, 0},
                                                   {0, 140, 170},
                                                   {226, 62, 150},
                                                   {92, 52, 20},
                                                   {98, 128, 0},
                                                   {120, 96, 224},
                                                   {24, 32, 84},
                                                   {118, 118, 124}}};
  return colours[cone % colours.size()];
}

Rgb seam_colour(int seam) {
  static constexpr std::array<Rgb, 6> colours = {
      {{238, 153, 34}, {34, 48, 92}, {238, 51, 119}, {0, 153, 136}, {187, 187, 51}, {102, 102, 102}}};
  return colours[seam % colours.size()];
}

Colour diverging_colour(double t) {
  constexpr double darkest = 0.46;
  static const Colour white = linear({244, 244, 242}), blue = at_lightness({33, 102, 172}, darkest),
                      red = at_lightness({178, 24, 43}, darkest);
  return between(white, t < 0 ? blue : red, std::abs(t));
}

Colour sequential_colour(double t) {
  // Three stops of equally spaced lightness.
  static const Colour pale = at_lightness({255, 247, 214}, 0.96), middle = at_lightness({221, 106, 96}, 0.66),
                      dark = at_lightness({80, 24, 96}, 0.36);
  return t < 0.5 ? between(pale, middle, 2 * t) : between(middle, dark, 2 * t - 1);
}

Colour scale_colour(Measure measure, double t) {
  return measure == Measure::area ? diverging_colour(2 * t - 1) : sequential_colour(t);
}

std::vector<Rgb> scale_colours(Measure measure, int count) {
  std::vector<Rgb> colours;
  colours.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k)
    colours.push_back(srgb(scale_colour(measure, static_cast<double>(k) / (count - 1))));
  return colours;
}

Rgb bar_colour(double shade) { return srgb(0.86F * diverging_colour(shade)); }

Rgb tone_colour(ChartTone tone) {
  switch (tone) {
    case ChartTone::ink:
      return ink::text;
    case ChartTone::energy:
      return {0, 92, 160};
    case ChartTone::gradient:
      return {204, 85, 17};
  }
  return ink::text;
}

Rgb on_dark(const Rgb& colour) {
  constexpr double light = 0.78;
  return srgb(at_lightness(colour, light));
}

}  // namespace orbitutte
