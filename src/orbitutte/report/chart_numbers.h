// SPDX-License-Identifier: MIT
// The numbers on axes: where they stand, and how they are written.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/report/chart.h"

namespace orbitutte {

/// The title of axes and scales over log2 A. Both areas are shares of the whole.
constexpr const char* area_axis_title = "← shrunk    area ratio A (image / mesh)    enlarged →";

/// The value that the share q of all absolute values stays below; 0 if there are no values.
double quantile_of_magnitudes(const std::vector<double>& values, double q);

/// The value that the share q of all values stays below; 0 if there are no values.
double quantile(std::vector<double> values, double q);

/// 1, 2 or 5 times a power of ten, such that at most `count` steps lead up to `largest`.
double round_step(double largest, int count);

/// At whole numbers k from -range to range in equal steps, seven at most: "1/8", "1", "8" for -3, 0, 3, and
/// powers of two, "2⁻¹²", where such fractions would be too long.
std::vector<ChartTick> octave_ticks(double range);

/// The power as text, "10⁻³"; the exponent in small raised digits.
std::string power_text(int base, int exponent);

}  // namespace orbitutte
