// SPDX-License-Identifier: MIT
#include "orbitutte/report/charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "orbitutte/report/chart_numbers.h"

namespace orbitutte {
namespace {

constexpr std::size_t bins = 61;

// The smallest half width, in octaves, that holds nearly all values, with some room. Each ends at a tick.
double reach_of_bins(const std::vector<double>& log_areas) {
  constexpr std::array ranges = {1.0, 2.0, 3.0, 4.0, 6.0, 9.0, 12.0, 15.0};
  const double wanted = 1.05 * quantile_of_magnitudes(log_areas, 0.97);
  for (const double range : ranges)
    if (wanted <= range) return range;
  return ranges.back();
}

// The outermost numbers say so if faces lie beyond them.
ChartAxis area_axis(const HistogramAxes& axes) {
  ChartAxis axis = {area_axis_title, -axes.range, axes.range, octave_ticks(axes.range)};
  if (axes.lowest < axis.low) axis.ticks.front().text.insert(0, "≤ ");
  if (axes.largest > axis.high) axis.ticks.back().text.insert(0, "≥ ");
  return axis;
}

ChartAxis share_axis(double highest) {
  ChartAxis axis = {"share of faces", 0, highest, {}};
  const double step = round_step(highest, 5);
  for (double share = step; share <= highest; share += step)
    axis.ticks.push_back({share, fmt::format("{:.3g}%", 100 * share)});
  return axis;
}

std::vector<ChartBar> area_bars(const std::vector<double>& shares, const HistogramAxes& axes) {
  const double bar_width = 2 * axes.range / static_cast<double>(shares.size());
  std::vector<ChartBar> bars;
  for (std::size_t k = 0; k < shares.size(); ++k) {
    const double from = -axes.range + bar_width * static_cast<double>(k);
    bars.push_back({from, from + bar_width, shares[k], (from + bar_width / 2) / axes.colours});
  }
  return bars;
}

// Upright at a value of log2 A; its label has A.
ChartLine upright(const char* label, double log_area, const Chart& chart, ChartStroke stroke) {
  const double at = std::clamp(log_area, chart.x.low, chart.x.high);
  return {fmt::format("{} {:.3g}", label, std::exp2(log_area)),
          {{at, chart.y.low}, {at, chart.y.high}},
          ChartTone::ink,
          stroke,
          ChartDots::none};
}

// The points (k, log10 of the k-th value) of the values that are positive.
std::vector<Eigen::Vector2d> logarithmic(const std::vector<double>& values) {
  std::vector<Eigen::Vector2d> points;
  for (std::size_t k = 0; k < values.size(); ++k)
    if (values[k] > 0 && std::isfinite(values[k]))
      points.emplace_back(static_cast<double>(k), std::log10(values[k]));
  return points;
}

// The whole decades that hold all points; none if there are no points.
std::optional<std::pair<int, int>> decades(const std::vector<ChartLine>& lines) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const ChartLine& line : lines)
    for (const Eigen::Vector2d& point : line.points)
      low = std::min(low, point[1]), high = std::max(high, point[1]);
  if (!(low <= high)) return std::nullopt;
  const int first = static_cast<int>(std::floor(low));
  return std::pair(first, std::max(first + 1, static_cast<int>(std::ceil(high))));
}

ChartAxis decade_axis(int first, int last) {
  ChartAxis axis = {"logarithmic", static_cast<double>(first), static_cast<double>(last), {}};
  const int stride = (last - first + 5) / 6;
  for (int k = last; k >= first; k -= stride)
    axis.ticks.push_back({static_cast<double>(k), power_text(10, k)});
  return axis;
}

ChartAxis iteration_axis(std::size_t rows) {
  const double last = std::max(1.0, static_cast<double>(rows) - 1);
  ChartAxis axis = {"iteration", 0, last, {}};
  const double step = std::max(1.0, round_step(last, 8));
  for (double k = 0; k <= last; k += step) axis.ticks.push_back({k, fmt::format("{:.0f}", k)});
  return axis;
}

}  // namespace

std::vector<double> shares_by_bin(const std::vector<double>& log_areas, double range) {
  std::vector<double> shares(bins, 0.0);
  const double count = static_cast<double>(bins), share = 1.0 / static_cast<double>(log_areas.size());
  for (const double value : log_areas) {
    const double at = std::clamp((value / range + 1) / 2 * count, 0.0, count - 0.5);
    shares[static_cast<std::size_t>(at)] += share;
  }
  return shares;
}

HistogramAxes histogram_axes(const std::vector<std::vector<double>>& maps) {
  HistogramAxes axes;
  axes.highest = 1e-9;
  for (const std::vector<double>& map : maps) {
    axes.range = std::max(axes.range, reach_of_bins(map));
    for (const double value : map)
      axes.lowest = std::min(axes.lowest, value), axes.largest = std::max(axes.largest, value);
  }
  for (const std::vector<double>& map : maps) {
    const std::vector<double> shares = shares_by_bin(map, axes.range);
    axes.highest = std::max(axes.highest, 1.05 * *std::max_element(shares.begin(), shares.end()));
  }
  axes.colours = common_colour_scale(Measure::area, maps).axis.high;
  return axes;
}

Chart area_histogram(const std::vector<double>& log_areas, const HistogramAxes& axes) {
  if (log_areas.empty()) return {};
  const double count = static_cast<double>(log_areas.size());
  Chart chart = {"Histogram of area distortion: which share of the faces has which area ratio",
                 area_axis(axes),
                 share_axis(axes.highest),
                 area_bars(shares_by_bin(log_areas, axes.range), axes),
                 {}};
  chart.lines = {upright("median", quantile(log_areas, 0.5), chart, ChartStroke::full),
                 upright("geometric mean", std::accumulate(log_areas.begin(), log_areas.end(), 0.0) / count,
                         chart, ChartStroke::dashed)};
  return chart;
}

Chart area_histogram(const std::vector<double>& log_areas) {
  return area_histogram(log_areas, histogram_axes({log_areas}));
}

Chart convergence_chart(const std::vector<Iteration>& history) {
  std::vector<double> excess, gradient;
  for (const Iteration& row : history) {
    excess.push_back((row.energy - history.back().energy) / history.back().energy);
    gradient.push_back(row.gradient_norm);
  }
  constexpr std::size_t few = 60;
  const ChartDots dots = history.size() <= few ? ChartDots::every_point : ChartDots::none;
  std::vector<ChartLine> lines = {
      {"(energy − last) / last", logarithmic(excess), ChartTone::energy, ChartStroke::full, dots},
      {"gradient norm", logarithmic(gradient), ChartTone::gradient, ChartStroke::full, dots}};
  const auto range = decades(lines);
  if (!range) return {};
  return {"Convergence of the optimiser: energy and gradient norm by iteration, on a logarithmic axis",
          iteration_axis(history.size()),
          decade_axis(range->first, range->second),
          {},
          std::move(lines)};
}

}  // namespace orbitutte
