// SPDX-License-Identifier: MIT
#include "orbitutte/render/chart_drawing.h"

#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "orbitutte/report/charts.h"

namespace orbitutte {
namespace {

// What maps values to pixels: the axes, and the box that they enclose.
struct Plot {
  const Chart& chart;
  Box box;

  double x(double value) const { return box.x + share_along(chart.x, value) * box.width; }
  double y(double value) const { return box.bottom() - share_along(chart.y, value) * box.height; }
  Place at(const Eigen::Vector2d& point) const { return {x(point[0]), y(point[1])}; }
};

// What the numbers, titles and key leave of a box.
Box plot_area(const Canvas& canvas, const Box& box) {
  const double em = canvas.em();
  return box.inset(4.6 * em, 2.2 * em, 1.5 * em, 3.6 * em);
}

void draw_x_axis(Canvas& canvas, const Plot& plot) {
  const double em = canvas.em(), bottom = plot.box.bottom();
  for (const ChartTick& tick : plot.chart.x.ticks) {
    const double x = plot.x(tick.at);
    canvas.line({{x, bottom}, {x, bottom + 0.3 * em}}, {.colour = ink::quiet});
    canvas.text({x, bottom + 1.4 * em}, tick.text, {.size = 0.9, .align = Align::centre});
  }
  canvas.text({plot.box.x + 0.5 * plot.box.width, bottom + 2.9 * em}, plot.chart.x.title,
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre});
}

// With a line across the plot at every number, and the title upwards.
void draw_y_axis(Canvas& canvas, const Plot& plot) {
  const double em = canvas.em();
  for (const ChartTick& tick : plot.chart.y.ticks) {
    const double y = plot.y(tick.at);
    canvas.line({{plot.box.x, y}, {plot.box.right(), y}}, {.width = 0.05, .colour = ink::hairline});
    canvas.text({plot.box.x - 0.4 * em, y + 0.32 * em}, tick.text, {.size = 0.9, .align = Align::right});
  }
  constexpr double upwards = -std::numbers::pi / 2;
  canvas.text({plot.box.x - 3.5 * em, plot.box.y + 0.5 * plot.box.height}, plot.chart.y.title,
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre, .angle = upwards});
}

// The left and the lower side.
void draw_frame(Canvas& canvas, const Box& box) {
  canvas.line({{box.x, box.y}, {box.x, box.bottom()}, {box.right(), box.bottom()}}, {.colour = ink::quiet});
}

void draw_bar(Canvas& canvas, const Plot& plot, const ChartBar& bar) {
  const double left = plot.x(bar.from), top = plot.y(std::min(bar.height, plot.chart.y.high));
  canvas.box({left, top, plot.x(bar.to) - left, plot.box.bottom() - top}, bar_colour(bar.shade));
}

LineStyle style_of(const ChartLine& line) {
  return {
      .width = 0.13, .colour = tone_colour(line.tone), .dash = line.stroke == ChartStroke::dashed ? 0.4 : 0};
}

void draw_line(Canvas& canvas, const Plot& plot, const ChartLine& line) {
  std::vector<Place> points;
  for (const Eigen::Vector2d& point : line.points) points.push_back(plot.at(point));
  canvas.line(points, style_of(line));
  if (line.dots == ChartDots::none) return;
  for (const Place& point : points) canvas.disc(point, 0.24 * canvas.em(), tone_colour(line.tone));
}

// In a row above the plot that ends at its right side, with each label after a piece of its line.
void draw_key(Canvas& canvas, const Plot& plot) {
  const double em = canvas.em(), y = plot.box.y - 1.2 * em;
  double x = plot.box.right();
  for (auto line = plot.chart.lines.rbegin(); line != plot.chart.lines.rend(); ++line) {
    x -= canvas.text_width(line->label, {.size = 0.9});
    canvas.text({x, y}, line->label, {.size = 0.9, .colour = ink::quiet});
    canvas.line({{x - 2 * em, y - 0.32 * em}, {x - 0.4 * em, y - 0.32 * em}}, style_of(*line));
    x -= 3.2 * em;
  }
}

// An outermost bar that is higher than the box has a gap, and its share stands above it, unless that is next
// to nothing.
void finish_outermost(Canvas& canvas, const Plot& plot, const ChartBar& bar) {
  if (bar.height < 0.005) return;
  const double em = canvas.em(), left = plot.x(bar.from), width = plot.x(bar.to) - left;
  const double top = plot.y(std::min(bar.height, plot.chart.y.high));
  if (bar.height > plot.chart.y.high)
    canvas.box({left - 1, plot.box.y + 0.25 * plot.box.height, width + 2, 0.25 * em}, ink::paper);
  canvas.text({left + 0.5 * width, top - 0.3 * em}, fmt::format("{:.0f}%", 100 * bar.height),
              {.size = 0.8, .colour = ink::quiet, .align = Align::centre});
}

// Smaller if it would be wider than the box.
void draw_scale_title(Canvas& canvas, const Box& box, const std::string& title) {
  TextStyle style = {.size = 0.9, .colour = ink::quiet, .align = Align::centre};
  style.size *= std::min(1.0, box.width / canvas.text_width(title, style));
  canvas.text({box.x + 0.5 * box.width, box.y + 3.6 * canvas.em()}, title, style);
}

}  // namespace

void draw_chart(Canvas& canvas, const Box& box, const Chart& chart) {
  if (chart.is_empty()) {
    canvas.text({box.x + 0.5 * box.width, box.y + 0.5 * box.height}, "nothing to show",
                {.colour = ink::quiet, .align = Align::centre});
    return;
  }
  const Plot plot = {chart, plot_area(canvas, box)};
  draw_y_axis(canvas, plot);
  for (const ChartBar& bar : chart.bars) draw_bar(canvas, plot, bar);
  draw_frame(canvas, plot.box);
  draw_x_axis(canvas, plot);
  for (const ChartLine& line : chart.lines) draw_line(canvas, plot, line);
  draw_key(canvas, plot);
}

Box scale_bar(const Canvas& canvas, const Box& box) {
  const double em = canvas.em(), width = std::min(0.7 * box.width, 22 * em);
  return {box.x + 0.5 * (box.width - width), box.y + 0.4 * em, width, 0.8 * em};
}

void draw_scale(Canvas& canvas, const Box& box, const ColourScale& scale) {
  const double em = canvas.em();
  const Box bar = scale_bar(canvas, box);
  constexpr int steps = 256;
  const std::vector<Rgb> colours = scale_colours(scale.measure, steps);
  for (int k = 0; k < steps; ++k)
    // Each strip reaches below the next one: no gaps where they meet inside a pixel.
    canvas.box({bar.x + bar.width * k / steps, bar.y, bar.width - bar.width * k / steps, bar.height},
               colours[k]);
  for (const ChartTick& tick : scale.axis.ticks) {
    const double x = bar.x + share_along(scale.axis, tick.at) * bar.width;
    canvas.line({{x, bar.bottom()}, {x, bar.bottom() + 0.3 * em}}, {.colour = ink::quiet});
    canvas.text({x, bar.bottom() + 1.3 * em}, tick.text, {.size = 0.9, .align = Align::centre});
  }
  draw_scale_title(canvas, box, scale.axis.title);
}

void draw_bars_on_scale(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                        const ColourScale& scale) {
  HistogramAxes axes;
  axes.range = axes.colours = scale.axis.high;
  const std::vector<double> shares = shares_by_bin(log_areas, axes.range);
  axes.highest = std::max(*std::max_element(shares.begin() + 1, shares.end() - 1), 1e-9);
  const Chart chart = area_histogram(log_areas, axes);
  if (chart.is_empty()) return;
  const Plot plot = {chart, box};
  for (const ChartBar& bar : chart.bars) draw_bar(canvas, plot, bar);
  finish_outermost(canvas, plot, chart.bars.front());
  finish_outermost(canvas, plot, chart.bars.back());
}

}  // namespace orbitutte
