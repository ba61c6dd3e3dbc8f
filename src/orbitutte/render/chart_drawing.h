// SPDX-License-Identifier: MIT
// Charts and scales of colours through Cairo.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/render/canvas.h"
#include "orbitutte/report/chart.h"
#include "orbitutte/report/colour_scale.h"

namespace orbitutte {

/// Draws a chart in a box that also holds the numbers and titles of both axes and the key. For an empty
/// chart it says that there is nothing to show.
void draw_chart(Canvas& canvas, const Box& box, const Chart& chart);

/// Where a scale's bar of colours is in its box.
Box scale_bar(const Canvas& canvas, const Box& box);

/// A bar of colours with numbers below it and a title, centred in the box (which should be 4 ems high). The
/// title is made smaller if the box is narrow.
void draw_scale(Canvas& canvas, const Box& box, const ColourScale& scale);

/// Bars alone, over the bar of colours of a scale of areas (scale_bar) and as wide. The outermost bars hold
/// what lies at the scale's ends and beyond. If they are higher than all others they are cut off, and their
/// shares are written above them.
void draw_bars_on_scale(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                        const ColourScale& scale);

}  // namespace orbitutte
