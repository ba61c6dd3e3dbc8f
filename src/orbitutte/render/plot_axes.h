// SPDX-License-Identifier: MIT
// Axes of plots, with their numbers and labels.
#pragma once

#include <string>

#include "orbitutte/render/canvas.h"

namespace orbitutte {

/// A linear map of an interval of values onto pixels.
struct Axis {
  double low = 0, high = 1;    ///< values
  double first = 0, last = 1;  ///< pixels

  double operator()(double value) const { return first + (value - low) / (high - low) * (last - first); }
};

/// Where a plot's axes are, in a box that also holds their numbers and labels.
Box plot_area(const Canvas& canvas, const Box& box);

/// The left and the lower side.
void draw_frame(Canvas& canvas, const Box& plot);

void draw_x_tick(Canvas& canvas, const Box& plot, double x, const std::string& text);

/// With a line across the plot.
void draw_y_tick(Canvas& canvas, const Box& plot, double y, const std::string& text);

/// Below the numbers, in the middle.
void draw_x_label(Canvas& canvas, const Box& plot, const std::string& text);

/// Upwards, left of the numbers.
void draw_y_label(Canvas& canvas, const Box& plot, const std::string& text);

/// The power as text, "10⁻³"; the exponent in small raised digits.
std::string power(int base, int exponent);

/// A round number of at most `count` steps up to `largest`: 1, 2 or 5 times a power of ten.
double round_step(double largest, int count);

}  // namespace orbitutte
