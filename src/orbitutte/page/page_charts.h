// SPDX-License-Identifier: MIT
// The page's charts as inline SVG: text and axes in the page's own colours, readable without script.
#pragma once

#include <string>
#include <vector>

namespace orbitutte {

/// Counts of log2 A between `edges` (one more than counts), the first and last bin open.
struct HistogramChart {
  std::vector<double> edges;
  std::vector<double> counts;
};

/// Empty where there is nothing to count.
std::string histogram_svg(const HistogramChart& chart);

/// A value for every iterate, drawn on a logarithmic axis; values that are not positive are left out.
struct ConvergenceSeries {
  std::string label;
  std::vector<double> values;
};

/// Empty where no series has a positive value.
std::string convergence_svg(const std::vector<ConvergenceSeries>& series);

/// A bar whose length is a share in [0, 1] of the width.
std::string bar_svg(double share);

}  // namespace orbitutte
