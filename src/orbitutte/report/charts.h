// SPDX-License-Identifier: MIT
// The charts of an embedding: area distortion by face (figure 12), and how the optimiser converged.
#pragma once

#include <vector>

#include "orbitutte/minimum.h"
#include "orbitutte/report/chart.h"
#include "orbitutte/report/colour_scale.h"

namespace orbitutte {

/// What comparable histograms share: bins, both axes, and the colours of bars.
struct HistogramAxes {
  /// bins run from log2 A = -range to range; the outermost hold all beyond
  double range = 1;
  /// the share of faces at the upper end of the vertical axis
  double highest = 1;
  /// log2 A of any map
  double lowest = 0;
  /// log2 A of any map
  double largest = 0;
  /// the strongest colours stand for log2 A <= -colours and >= colours
  double colours = 1;
};

/// The shares of all values in equal bins from -range to range, the outermost open. They add up to 1 unless
/// there is no value.
std::vector<double> shares_by_bin(const std::vector<double>& log_areas, double range);

/// Axes that suit all of these maps (log2 A of each): no map has more than a thirtieth of its faces beyond
/// the ends unless areas differ by more than 2^15.
HistogramAxes histogram_axes(const std::vector<std::vector<double>>& maps);

/// The shares of faces by log2 A, with lines at the median and the geometric mean of A. Empty if nothing is
/// measured.
Chart area_histogram(const std::vector<double>& log_areas, const HistogramAxes& axes);

/// The same on axes of its own.
Chart area_histogram(const std::vector<double>& log_areas);

/// The energy's excess over its last value and the gradient's norm by iteration, on a logarithmic axis;
/// values that are not positive are left out. Empty if none is positive.
Chart convergence_chart(const std::vector<Iteration>& history);

}  // namespace orbitutte
