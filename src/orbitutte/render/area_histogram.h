// SPDX-License-Identifier: MIT
// Histograms of area distortion, log2 A by triangle (figure 12).
#pragma once

#include <vector>

#include "orbitutte/render/scales.h"

namespace orbitutte {

/// What histograms share that are to be compared: their bins, both axes, and the colours of their bars.
struct HistogramAxes {
  double range = 1;                ///< bins run from log2 A = -range to range; the outermost hold all beyond
  double highest = 1;              ///< the share of triangles at the upper end of the vertical axis
  double lowest = 0, largest = 0;  ///< log2 A of any map
  AreaScale scale;
};

/// The shares of all values in equal bins from -range to range, the outermost open. They add up to 1 unless
/// there is no value.
std::vector<double> shares_by_bin(const std::vector<double>& log_areas, double range);

/// Axes that suit all of these maps (log_areas of each): none loses more than a thirtieth of its triangles
/// beyond the ends unless areas differ by more than 2^15.
HistogramAxes histogram_axes(const std::vector<std::vector<double>>& maps);

/// In a box that also holds the numbers and labels of both axes.
void draw_histogram(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                    const HistogramAxes& axes);

/// Over a histogram: full and dashed lines at the median and the geometric mean of A, and their values above.
void draw_centres(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                  const HistogramAxes& axes);

/// Bars alone, over a bar of the scale's colours (scale_bar) and as wide. What lies at the scale's ends and
/// beyond is in the outermost bars, which are cut off where they are higher than all others, and have their
/// shares written above them.
void draw_bars_on_scale(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                        const AreaScale& scale);

}  // namespace orbitutte
