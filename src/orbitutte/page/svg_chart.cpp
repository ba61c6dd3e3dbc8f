// SPDX-License-Identifier: MIT
#include "orbitutte/page/svg_chart.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/export/palette.h"

namespace orbitutte {
namespace {

// In units of the picture.
constexpr double width = 480, height = 330, left = 76, right = 468, bottom = 276, key_row = 22;

// What maps values to units: the axes, and where the plot begins below the key.
struct Plot {
  const Chart& chart;
  double top;

  double x(double value) const { return left + share_along(chart.x, value) * (right - left); }
  double y(double value) const { return bottom - share_along(chart.y, value) * (bottom - top); }
};

std::string coordinate(double value) { return fmt::format("{:.1f}", value); }

std::string segment(double x1, double y1, double x2, double y2) {
  return fmt::format("M{:.1f} {:.1f}L{:.1f} {:.1f}", x1, y1, x2, y2);
}

Content stroke(const std::string& path, const std::string& css_class) {
  return {{"path", path}, {"class", css_class}};
}

Content text(double x, double y, const char* css_class, const std::string& words) {
  return {{"x", coordinate(x)}, {"y", coordinate(y)}, {"class", css_class}, {"text", words}};
}

const char* class_of(ChartTone tone) {
  switch (tone) {
    case ChartTone::ink:
      return "ink";
    case ChartTone::energy:
      return "energy";
    case ChartTone::gradient:
      return "gradient";
  }
  return "";
}

std::string class_of(const ChartLine& line) {
  return std::string("line ") + class_of(line.tone) + (line.stroke == ChartStroke::dashed ? " dashed" : "");
}

void add_axes(const Plot& plot, Content& content) {
  Content &grid = content["grid"], &texts = content["texts"];
  for (const ChartTick& tick : plot.chart.y.ticks) {
    const double y = plot.y(tick.at);
    grid.push_back(stroke(segment(left, y, right, y), "grid"));
    texts.push_back(text(left - 8, y + 5, "end", tick.text));
  }
  for (const ChartTick& tick : plot.chart.x.ticks) {
    const double x = plot.x(tick.at);
    grid.push_back(stroke(segment(x, bottom, x, bottom + 5), "axis"));
    texts.push_back(text(x, bottom + 22, "middle", tick.text));
  }
  texts.push_back(text((left + right) / 2, height - 8, "middle", plot.chart.x.title));
  content["y_title"] = text(15, (plot.top + bottom) / 2, "middle", plot.chart.y.title);
  content["frame"] = fmt::format("M{:.1f} {:.1f}V{:.1f}H{:.1f}", left, plot.top, bottom, right);
}

void add_bars(const Plot& plot, Content& content) {
  for (const ChartBar& bar : plot.chart.bars) {
    const double top = plot.y(std::min(bar.height, plot.chart.y.high));
    const std::string path = fmt::format("M{:.2f} {:.1f}V{:.2f}H{:.2f}V{:.1f}Z", plot.x(bar.from), bottom,
                                         top, plot.x(bar.to), bottom);
    content["bars"].push_back({{"path", path}, {"colour", hexadecimal(bar_colour(bar.shade))}});
  }
}

void add_line(const Plot& plot, const ChartLine& line, Content& content) {
  std::string path;
  for (const Eigen::Vector2d& point : line.points) {
    const double x = plot.x(point[0]), y = plot.y(point[1]);
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", x, y);
    if (line.dots == ChartDots::every_point)
      content["dots"].push_back({{"x", coordinate(x)}, {"y", coordinate(y)}, {"class", class_of(line.tone)}});
  }
  content["lines"].push_back(stroke(path, class_of(line)));
}

// Rows above the plot, each label before a piece of its line.
void add_key(const Plot& plot, Content& content) {
  double y = plot.top - key_row * static_cast<double>(plot.chart.lines.size()) + 8;
  for (const ChartLine& line : plot.chart.lines) {
    content["lines"].push_back(stroke(segment(right - 28, y, right, y), class_of(line)));
    content["texts"].push_back(text(right - 36, y + 5, "end", line.label));
    y += key_row;
  }
}

}  // namespace

Content svg_chart(const Chart& chart) {
  if (chart.is_empty()) return false;
  const Plot plot = {chart, 8 + key_row * static_cast<double>(chart.lines.size())};
  Content content = {{"width", coordinate(width)},       {"height", coordinate(height)},
                     {"description", chart.description}, {"grid", Content::array()},
                     {"bars", Content::array()},         {"lines", Content::array()},
                     {"dots", Content::array()},         {"texts", Content::array()}};
  add_axes(plot, content);
  add_bars(plot, content);
  for (const ChartLine& line : chart.lines) add_line(plot, line, content);
  add_key(plot, content);
  return content;
}

}  // namespace orbitutte
