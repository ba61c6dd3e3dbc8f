// SPDX-License-Identifier: MIT
// What each colour means: the one table for files, pictures and the page.
#pragma once

#include <vector>

#include "orbitutte/export/colour.h"
#include "orbitutte/report/chart.h"
#include "orbitutte/report/colour_scale.h"

namespace orbitutte {

/// The number of colours of copies: enough for a tile with seven neighbours, three pairs of sides and a
/// mirror.
constexpr int palette_size = 8;

/// The copy with this colour number (modulo palette_size), a shade darker if it is mirrored. All sixteen are
/// distinct, even with 5 bits a channel.
Rgb tile_colour(int colour, bool mirrored);

/// The source, and the tile itself among its copies.
constexpr Rgb bold_colour = {86, 142, 205};

/// Marked vertices and seams, by their number in the embedding; the lists start again at their ends, after
/// twelve and six. Those of marked vertices are dark enough for white numbers.
Rgb cone_colour(int cone);
Rgb seam_colour(int seam);

/// Area distortion: blue, white, red for t = -1, 0, 1 (clamped). Lightness is linear in |t| and the same for
/// t and -t.
Colour diverging_colour(double t);

/// Angle distortion: from pale yellow at t = 0 to dark violet at t = 1 (clamped). Lightness falls linearly.
Colour sequential_colour(double t);

/// The colour at the share t, 0 .. 1, of the scale of a measure.
Colour scale_colour(Measure measure, double t);

/// The colours of the scale of a measure, `count` of them in equal steps.
std::vector<Rgb> scale_colours(Measure measure, int count);

/// A bar of a chart, whose place on the scale of area distortion is -1 .. 1: a little darker than the scale,
/// so that the bars in the middle stand out from the paper.
Rgb bar_colour(double shade);

/// A line of a chart on white paper.
Rgb tone_colour(ChartTone tone);

/// The same colour, light enough for a dark ground.
Rgb on_dark(const Rgb& colour);

namespace ink {
constexpr Rgb paper = {255, 255, 255};
constexpr Rgb text = {34, 34, 38};
/// captions, ticks
constexpr Rgb quiet = {110, 110, 118};
/// grids
constexpr Rgb hairline = {208, 208, 214};
/// a surface without colours of its own
constexpr Rgb figure = {226, 222, 214};
/// a face whose distortion is not measured
constexpr Rgb unmeasured = {150, 150, 150};
}  // namespace ink

}  // namespace orbitutte
