// SPDX-License-Identifier: MIT
// Colours as files have them, and in linear light, in which they can be added and averaged.
#pragma once

#include <cstdint>
#include <string>

#include "orbitutte/types.h"

namespace orbitutte {

/// sRGB (IEC 61966-2-1), as files and screens take it.
struct Rgb {
  std::uint8_t red = 0;
  std::uint8_t green = 0;
  std::uint8_t blue = 0;

  bool operator==(const Rgb&) const = default;
};

/// Red, green and blue in linear light, 0 .. 1: colours that may be added, scaled and averaged.
using Colour = Eigen::Array3f;

/// From sRGB, and back to it: clamped to 0 .. 1 and rounded.
Colour linear(const Rgb& colour);
Rgb srgb(const Colour& colour);

/// (1 - t) a + t b.
Colour mix(const Colour& a, const Colour& b, float t);

/// Lightness L of Oklab, 0 (black) .. 1 (white).
double lightness(const Colour& colour);

/// The point t in 0 .. 1 (clamped) of the straight line between two colours in Oklab, where equal steps look
/// equal.
Colour between(const Colour& from, const Colour& to, double t);

/// The same colour at another lightness of Oklab. Channels that no screen can show are clamped.
Colour at_lightness(const Rgb& colour, double lightness);

/// "#0b5fbd".
std::string hexadecimal(const Rgb& colour);

}  // namespace orbitutte
