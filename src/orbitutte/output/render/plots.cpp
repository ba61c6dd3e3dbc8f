// SPDX-License-Identifier: MIT
#include "orbitutte/output/render/plots.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <string>

#include "orbitutte/output/render/scales.h"

namespace orbitutte {
namespace {

// A linear map of an interval of values onto pixels.
struct Axis {
  double low, high;    // values
  double first, last;  // pixels

  double operator()(double value) const { return first + (value - low) / (high - low) * (last - first); }
};

std::string power_of_ten(int exponent) {
  static constexpr std::array<const char*, 10> digits = {"⁰", "¹", "²", "³", "⁴", "⁵", "⁶", "⁷", "⁸", "⁹"};
  std::string text = exponent < 0 ? "10⁻" : "10";
  for (const char digit : std::to_string(std::abs(exponent))) text += digits[digit - '0'];
  return text;
}

void draw_frame(Canvas& canvas, const Box& box) {
  canvas.line({{box.x, box.y}, {box.x, box.bottom()}, {box.right(), box.bottom()}}, {.colour = ink::quiet});
}

void x_label(Canvas& canvas, const Box& plot, const std::string& text) {
  canvas.text({plot.x + 0.5 * plot.width, plot.bottom() + 2.9 * canvas.em()}, text,
              {.colour = ink::quiet, .align = Align::centre});
}

void x_tick(Canvas& canvas, const Box& plot, double x, const std::string& text) {
  const double em = canvas.em();
  canvas.line({{x, plot.bottom()}, {x, plot.bottom() + 0.3 * em}}, {.colour = ink::quiet});
  canvas.text({x, plot.bottom() + 1.4 * em}, text, {.size = 0.9, .align = Align::centre});
}

void y_tick(Canvas& canvas, const Box& plot, double y, const std::string& text) {
  const double em = canvas.em();
  canvas.line({{plot.x, y}, {plot.right(), y}}, {.width = 0.05, .colour = ink::hairline});
  canvas.text({plot.x - 0.4 * em, y + 0.32 * em}, text, {.size = 0.9, .align = Align::right});
}

// A round number of at most `count` steps up to `largest`: 1, 2 or 5 times a power of ten.
double round_step(double largest, int count) {
  const double raw = largest / count, decade = std::pow(10, std::floor(std::log10(raw)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (factor * decade >= raw * (1 - 1e-9)) return factor * decade;
  return 10 * decade;
}

struct Bins {
  double range;
  std::vector<double> shares;   // of all values, in equal bins from -range to range
  double below = 0, above = 0;  // the shares beyond the range, which the outermost bins contain
};

Bins bins_of(const std::vector<double>& values) {
  std::vector<double> magnitudes = values;
  for (double& value : magnitudes) value = std::abs(value);
  Bins bins = {std::clamp(std::ceil(2 * 1.05 * quantile(magnitudes, 0.97)) / 2, 1.0, 16.0),
               std::vector<double>(61, 0.0)};
  const double count = static_cast<double>(bins.shares.size());
  for (const double value : values) {
    const double at = std::clamp((value / bins.range + 1) / 2 * count, 0.0, count - 0.5);
    const double share = 1.0 / static_cast<double>(values.size());
    bins.shares[static_cast<std::size_t>(at)] += share;
    if (value < -bins.range) bins.below += share;
    if (value > bins.range) bins.above += share;
  }
  return bins;
}

// Where a plot's axes are, in a box that also holds its numbers and labels.
Box plot_area(const Canvas& canvas, const Box& box) {
  const double em = canvas.em();
  return box.inset(4 * em, 2.2 * em, em, 3.6 * em);
}

void draw_bars(Canvas& canvas, const Box& plot, const Bins& bins, const AreaScale& scale) {
  const double count = static_cast<double>(bins.shares.size()), width = plot.width / count;
  const double highest = *std::max_element(bins.shares.begin(), bins.shares.end());
  const Axis y = {0, std::max(1.05 * highest, 1e-9), plot.bottom(), plot.y};
  const double step = round_step(y.high, 5);
  for (double share = step; share <= y.high; share += step)
    y_tick(canvas, plot, y(share), fmt::format("{:.3g}%", 100 * share));
  for (std::size_t k = 0; k < bins.shares.size(); ++k) {
    const double left = plot.x + width * static_cast<double>(k), top = y(bins.shares[k]);
    const double middle = (2 * (static_cast<double>(k) + 0.5) / count - 1) * bins.range;
    canvas.box({left, top, width, plot.bottom() - top}, srgb(0.93F * diverging_colour(middle / scale.range)));
  }
}

// A full line at the median and a dashed one at the mean, and their values above the plot.
void mark_centres(Canvas& canvas, const Box& plot, const Axis& x, const std::vector<double>& values) {
  const double em = canvas.em();
  const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
  const double median = quantile(values, 0.5);
  const auto mark = [&](double value, const LineStyle& style) {
    const double at = x(std::clamp(value, x.low, x.high));
    canvas.line({{at, plot.bottom()}, {at, plot.y - 0.2 * em}}, style);
  };
  mark(median, {.width = 0.1});
  mark(mean, {.width = 0.1, .dash = 0.4});
  const std::string text = fmt::format("median {:.3g} (line),  geometric mean {:.3g} (dashed)",
                                       std::exp2(median), std::exp2(mean));
  canvas.text({plot.x + 0.5 * plot.width, plot.y - 1.2 * em}, text,
              {.size = 0.9, .colour = ink::quiet, .align = Align::centre});
}

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

void draw_histogram(Canvas& canvas, const Box& box, const std::vector<FaceDistortion>& faces) {
  const std::vector<double> values = log_areas(faces);
  const Bins bins = bins_of(values);
  const Box plot = plot_area(canvas, box);
  draw_bars(canvas, plot, bins, area_scale(faces));
  draw_frame(canvas, plot);
  const Axis x = {-bins.range, bins.range, plot.x, plot.right()};
  for (const int k : octaves(bins.range)) x_tick(canvas, plot, x(k), power_of_two(k));
  const bool is_open = std::max(bins.below, bins.above) > 0.002;
  x_label(canvas, plot,
          is_open ? "area, sphere : mesh  (outermost bars: and beyond)"
                  : "area on the sphere : area on the mesh");
  if (!values.empty()) mark_centres(canvas, plot, x, values);
}

void draw_convergence(Canvas& canvas, const Box& box, const std::vector<Iteration>& history) {
  const double em = canvas.em();
  const Box plot = plot_area(canvas, box);
  const auto series = convergence_series(history);
  const auto [first, last] = decades(series);
  const double iterations = std::max(1.0, static_cast<double>(history.size()) - 1);
  const Axis x = {0, iterations, plot.x + em, plot.right() - em};
  const Axis y = {static_cast<double>(first), static_cast<double>(last), plot.bottom(), plot.y};
  const int stride = (last - first + 5) / 6;
  for (int k = last; k >= first; k -= stride) y_tick(canvas, plot, y(k), power_of_ten(k));
  draw_frame(canvas, plot);
  const double step = std::max(1.0, round_step(iterations, 8));
  for (double k = 0; k <= iterations; k += step) x_tick(canvas, plot, x(k), fmt::format("{:.0f}", k));
  x_label(canvas, plot, "iteration");
  for (const Series& one : series) draw_series(canvas, one, x, y);
  draw_legend(canvas, {plot.right(), plot.y - 1.2 * em}, series);
}

}  // namespace orbitutte
