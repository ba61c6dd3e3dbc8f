// SPDX-License-Identifier: MIT
// Colours in linear light, and the maps and lists of colours that pictures use.
#pragma once

#include "orbitutte/export/palette.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// Red, green and blue in linear light, 0 .. 1: colours that may be added, scaled and averaged.
using Colour = Eigen::Array3f;

/// From sRGB (IEC 61966-2-1), and back to it: clamped to 0 .. 1 and rounded.
Colour linear(const Rgb& colour);
Rgb srgb(const Colour& colour);

/// (1 - t) a + t b.
Colour mix(const Colour& a, const Colour& b, float t);

/// Blue, white, red for t = -1, 0, 1 (clamped): lightness is linear in |t| and the same for t and -t.
Colour diverging_colour(double t);

/// From pale yellow at t = 0 to dark violet at t = 1 (clamped): lightness falls linearly.
Colour sequential_colour(double t);

/// Lightness L of Oklab, 0 (black) .. 1 (white).
double lightness(const Colour& colour);

/// Marked vertices and seams, by their number in the embedding; the lists start again at their ends.
Rgb cone_colour(int cone);
Rgb seam_colour(int seam);

namespace ink {
constexpr Rgb paper = {255, 255, 255};
constexpr Rgb text = {34, 34, 38};
constexpr Rgb quiet = {110, 110, 118};     ///< captions, ticks
constexpr Rgb hairline = {208, 208, 214};  ///< grids
constexpr Rgb figure = {226, 222, 214};    ///< a surface without colours of its own
}  // namespace ink

}  // namespace orbitutte
