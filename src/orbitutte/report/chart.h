// SPDX-License-Identifier: MIT
// What a chart shows. The page draws it as SVG, pictures draw it through Cairo; all words and numbers are
// made here.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

struct ChartTick {
  /// on the axis
  double at = 0;
  std::string text;
};

/// From `low` to `high`, linear. The axis of a quantity that is shown on a logarithmic scale runs over its
/// logarithm.
struct ChartAxis {
  std::string title;
  double low = 0;
  double high = 1;
  std::vector<ChartTick> ticks;
};

/// Where a value lies on the axis: 0 at its low end, 1 at its high end.
inline double share_along(const ChartAxis& axis, double value) {
  return (value - axis.low) / (axis.high - axis.low);
}

/// What a line stands for; tone_colour (export/palette.h) has the colours.
enum class ChartTone { ink, energy, gradient };

enum class ChartStroke { full, dashed };

/// Whether dots mark a line's points.
enum class ChartDots { none, every_point };

struct ChartLine {
  /// in the key
  std::string label;
  /// on the axes
  std::vector<Eigen::Vector2d> points;
  ChartTone tone = ChartTone::ink;
  ChartStroke stroke = ChartStroke::full;
  ChartDots dots = ChartDots::none;
};

/// From the horizontal axis up to `height`.
struct ChartBar {
  double from = 0;
  double to = 0;
  double height = 0;
  /// on the scale of area distortion, -1 .. 1: bar_colour (export/palette.h)
  double shade = 0;
};

struct Chart {
  /// for readers who cannot see the chart
  std::string description;
  ChartAxis x;
  ChartAxis y;
  std::vector<ChartBar> bars;
  std::vector<ChartLine> lines;

  bool is_empty() const { return bars.empty() && lines.empty(); }
};

}  // namespace orbitutte
