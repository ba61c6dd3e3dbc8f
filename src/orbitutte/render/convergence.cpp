// SPDX-License-Identifier: MIT
#include "orbitutte/render/convergence.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

#include "orbitutte/render/plot_axes.h"

namespace orbitutte {
namespace {

struct Series {
  std::string name;
  Rgb colour;
  std::vector<double> values;  // by iteration; those that are not positive are not shown
};

// Decades that hold all positive values.
std::array<int, 2> decades(const std::array<Series, 2>& all) {
  double low = 1e300, high = 0;
  for (const Series& series : all)
    for (const double value : series.values)
      if (value > 0) low = std::min(low, value), high = std::max(high, value);
  if (high == 0) return {-1, 0};
  const int first = static_cast<int>(std::floor(std::log10(low)));
  return {first, std::max(first + 1, static_cast<int>(std::ceil(std::log10(high))))};
}

void draw_series(Canvas& canvas, const Series& series, const Axis& x, const Axis& y) {
  std::vector<Place> points;
  for (std::size_t k = 0; k < series.values.size(); ++k)
    if (series.values[k] > 0) points.emplace_back(x(static_cast<double>(k)), y(std::log10(series.values[k])));
  canvas.line(points, {.width = 0.12, .colour = series.colour});
  if (points.size() > 60) return;
  for (const Place& point : points) canvas.disc(point, 0.24 * canvas.em(), series.colour);
}

// In a row that ends at `right`.
void draw_legend(Canvas& canvas, const Place& right, const std::array<Series, 2>& all) {
  const double em = canvas.em();
  double x = right[0];
  for (auto series = all.rbegin(); series != all.rend(); ++series) {
    x -= canvas.text_width(series->name, {.size = 0.9});
    canvas.text({x, right[1]}, series->name, {.size = 0.9, .colour = ink::quiet});
    canvas.line({{x - 2 * em, right[1] - 0.32 * em}, {x - 0.4 * em, right[1] - 0.32 * em}},
                {.width = 0.16, .colour = series->colour});
    x -= 3.2 * em;
  }
}

std::array<Series, 2> convergence_series(const std::vector<Iteration>& history) {
  Series excess = {"(energy − last) / last", {0, 92, 160}, {}},
         gradient = {"gradient norm", {204, 85, 17}, {}};
  for (const Iteration& row : history) {
    excess.values.push_back((row.energy - history.back().energy) / history.back().energy);
    gradient.values.push_back(row.gradient_norm);
  }
  return {excess, gradient};
}

}  // namespace

void draw_convergence(Canvas& canvas, const Box& box, const std::vector<Iteration>& history) {
  const double em = canvas.em();
  const Box plot = plot_area(canvas, box);
  const auto series = convergence_series(history);
  const auto [first, last] = decades(series);
  const double iterations = std::max(1.0, static_cast<double>(history.size()) - 1);
  const Axis x = {0, iterations, plot.x + em, plot.right() - em};
  const Axis y = {static_cast<double>(first), static_cast<double>(last), plot.bottom(), plot.y};
  const int stride = (last - first + 5) / 6;
  for (int k = last; k >= first; k -= stride) draw_y_tick(canvas, plot, y(k), power(10, k));
  draw_frame(canvas, plot);
  const double step = std::max(1.0, round_step(iterations, 8));
  for (double k = 0; k <= iterations; k += step) draw_x_tick(canvas, plot, x(k), fmt::format("{:.0f}", k));
  draw_x_label(canvas, plot, "iteration");
  for (const Series& one : series) draw_series(canvas, one, x, y);
  draw_legend(canvas, {plot.right(), plot.y - 1.2 * em}, series);
}

}  // namespace orbitutte
