// SPDX-License-Identifier: MIT
#include "orbitutte/render/area_histogram.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "orbitutte/render/plot_axes.h"

namespace orbitutte {
namespace {

// Half widths of histograms, in octaves: each ends at a number that octaves() lists.
constexpr std::array ranges = {1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 15.0};

// Numbers of wider histograms are written as powers: 1/32768 is too long.
constexpr double longest_fractions = 9;

// The smallest range that holds nearly all values, with some room.
double reach_of_bins(const std::vector<double>& log_areas) {
  std::vector<double> magnitudes = log_areas;
  for (double& value : magnitudes) value = std::abs(value);
  const double wanted = 1.05 * quantile(std::move(magnitudes), 0.97);
  for (const double range : ranges)
    if (wanted <= range) return range;
  return ranges.back();
}

double highest_of(const std::vector<double>& shares) {
  return *std::max_element(shares.begin(), shares.end());
}

// The middle of a bin, in log2 A.
double middle_of(std::size_t bin, std::size_t count, double range) {
  return (2 * (static_cast<double>(bin) + 0.5) / static_cast<double>(count) - 1) * range;
}

// A little darker than the scale, so that the bars in the middle stand out from the paper.
Rgb bar_colour(double log_area, const AreaScale& scale) {
  return srgb(0.86F * diverging_colour(log_area / scale.range));
}

// One bar for each bin, side by side; bars of share `highest` and more are as high as the box.
void draw_bars(Canvas& canvas, const Box& box, const std::vector<double>& shares, const HistogramAxes& axes) {
  const double width = box.width / static_cast<double>(shares.size());
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double height = std::min(shares[k] / axes.highest, 1.0) * box.height;
    canvas.box({box.x + width * static_cast<double>(k), box.bottom() - height, width, height},
               bar_colour(middle_of(k, shares.size(), axes.range), axes.scale));
  }
}

struct Bar {
  double left, width;  // in pixels
  double share;        // of all triangles
};

// An outermost bar that is higher than the box has a gap, and its share stands above it, unless that is next
// to nothing.
void finish_outermost(Canvas& canvas, const Box& box, const Bar& bar, double highest) {
  if (bar.share < 0.005) return;
  const double em = canvas.em(), top = box.bottom() - std::min(bar.share / highest, 1.0) * box.height;
  if (bar.share > highest)
    canvas.box({bar.left - 1, box.y + 0.25 * box.height, bar.width + 2, 0.25 * em}, ink::paper);
  canvas.text({bar.left + 0.5 * bar.width, top - 0.3 * em}, fmt::format("{:.0f}%", 100 * bar.share),
              {.size = 0.8, .colour = ink::quiet, .align = Align::centre});
}

void draw_share_ticks(Canvas& canvas, const Box& plot, const HistogramAxes& axes) {
  const Axis y = {0, axes.highest, plot.bottom(), plot.y};
  const double step = round_step(y.high, 5);
  for (double share = step; share <= y.high; share += step)
    draw_y_tick(canvas, plot, y(share), fmt::format("{:.3g}%", 100 * share));
  draw_y_label(canvas, plot, "triangles");
}

// The outermost numbers say so where triangles lie beyond them.
void draw_area_ticks(Canvas& canvas, const Box& plot, const HistogramAxes& axes) {
  const Axis x = {-axes.range, axes.range, plot.x, plot.right()};
  for (const int k : octaves(axes.range)) {
    const bool all_below = k <= -axes.range && axes.lowest < -axes.range,
               all_above = k >= axes.range && axes.largest > axes.range;
    const std::string number = axes.range > longest_fractions ? power(2, k) : power_of_two(k);
    draw_x_tick(canvas, plot, x(k), (all_below ? "≤ " : all_above ? "≥ " : "") + number);
  }
}

}  // namespace

std::vector<double> shares_by_bin(const std::vector<double>& log_areas, double range) {
  std::vector<double> shares(61, 0.0);
  const double count = static_cast<double>(shares.size());
  for (const double value : log_areas) {
    const double at = std::clamp((value / range + 1) / 2 * count, 0.0, count - 0.5);
    shares[static_cast<std::size_t>(at)] += 1.0 / static_cast<double>(log_areas.size());
  }
  return shares;
}

HistogramAxes histogram_axes(const std::vector<std::vector<double>>& maps) {
  HistogramAxes axes;
  axes.highest = 1e-9;
  for (const std::vector<double>& map : maps) {
    axes.range = std::max(axes.range, reach_of_bins(map));
    axes.scale.range = std::max(axes.scale.range, area_scale(map).range);
    for (const double value : map)
      axes.lowest = std::min(axes.lowest, value), axes.largest = std::max(axes.largest, value);
  }
  for (const std::vector<double>& map : maps)
    axes.highest = std::max(axes.highest, 1.05 * highest_of(shares_by_bin(map, axes.range)));
  return axes;
}

void draw_histogram(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                    const HistogramAxes& axes) {
  const Box plot = plot_area(canvas, box);
  draw_share_ticks(canvas, plot, axes);
  draw_bars(canvas, plot, shares_by_bin(log_areas, axes.range), axes);
  draw_frame(canvas, plot);
  draw_area_ticks(canvas, plot, axes);
  draw_x_label(canvas, plot, fmt::format("← shrunk    A = {}    enlarged →", area_ratio));
}

void draw_centres(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                  const HistogramAxes& axes) {
  if (log_areas.empty()) return;
  const double em = canvas.em();
  const Box plot = plot_area(canvas, box);
  const Axis x = {-axes.range, axes.range, plot.x, plot.right()};
  const double mean =
      std::accumulate(log_areas.begin(), log_areas.end(), 0.0) / static_cast<double>(log_areas.size());
  const double median = quantile(log_areas, 0.5);
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

void draw_bars_on_scale(Canvas& canvas, const Box& box, const std::vector<double>& log_areas,
                        const AreaScale& scale) {
  HistogramAxes axes;
  axes.range = scale.range, axes.scale = scale;
  const std::vector<double> shares = shares_by_bin(log_areas, axes.range);
  axes.highest = std::max(*std::max_element(shares.begin() + 1, shares.end() - 1), 1e-9);
  draw_bars(canvas, box, shares, axes);
  const double width = box.width / static_cast<double>(shares.size());
  finish_outermost(canvas, box, {box.x, width, shares.front()}, axes.highest);
  finish_outermost(canvas, box, {box.right() - width, width, shares.back()}, axes.highest);
}

}  // namespace orbitutte
