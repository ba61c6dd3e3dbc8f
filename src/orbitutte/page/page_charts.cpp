// SPDX-License-Identifier: MIT
#include "orbitutte/page/page_charts.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <optional>
#include <utility>

#include "orbitutte/export/html_text.h"

namespace orbitutte {
namespace {

/// The drawing area within a picture of 480 x 300 units; axes' labels stand in the margins.
constexpr double width = 480, height = 300, left = 64, right = 468, top = 14, bottom = 244;

/// A linear scale from values to units.
struct Scale {
  double from, to, start, end;

  double operator()(double value) const { return start + (value - from) / (to - from) * (end - start); }
};

std::string open_svg(const std::string& label) {
  return fmt::format("<svg class=\"chart\" viewBox=\"0 0 {} {}\" role=\"img\" aria-label=\"{}\">\n", width,
                     height, escape_html(label));
}

std::string text(double x, double y, const char* css_class, const std::string& words) {
  return fmt::format("<text x=\"{:.1f}\" y=\"{:.1f}\" class=\"{}\">{}</text>\n", x, y, css_class,
                     escape_html(words));
}

std::string line(double x1, double y1, double x2, double y2, const char* css_class) {
  return fmt::format("<path d=\"M{:.1f} {:.1f}L{:.1f} {:.1f}\" class=\"{}\"/>\n", x1, y1, x2, y2, css_class);
}

std::string x_tick(double x, const std::string& label) {
  return line(x, bottom, x, bottom + 5, "axis") + text(x, bottom + 22, "middle", label);
}

std::string y_tick(double y, const std::string& label) {
  return line(left, y, right, y, "grid") + text(left - 8, y + 5, "end", label);
}

std::string x_title(const std::string& words) {
  return text((left + right) / 2, height - 8, "middle", words);
}

/// 2^power as a ratio: 1/8, 1, 8.
std::string power_of_two(int power) {
  const long long value = 1LL << std::abs(power);
  return power < 0 ? fmt::format("1/{}", value) : fmt::format("{}", value);
}

/// About four steps of 1, 2 or 5 times a power of ten up to `largest`.
double tick_step(double largest) {
  const double rough = largest / 4, power = std::pow(10, std::floor(std::log10(rough)));
  for (const double factor : {1.0, 2.0, 5.0})
    if (rough <= factor * power) return factor * power;
  return 10 * power;
}

/// The decades that hold all positive values; none where there are none.
std::optional<std::pair<int, int>> decades(const std::vector<ConvergenceSeries>& series) {
  double smallest = std::numeric_limits<double>::infinity(), largest = 0;
  for (const ConvergenceSeries& one : series) {
    for (const double value : one.values) {
      if (!(value > 0) || !std::isfinite(value)) continue;
      smallest = std::min(smallest, value);
      largest = std::max(largest, value);
    }
  }
  if (!(largest > 0)) return std::nullopt;
  const int low = static_cast<int>(std::floor(std::log10(smallest)));
  return std::pair(low, std::max(static_cast<int>(std::ceil(std::log10(largest))), low + 1));
}

/// A line through the values, with a dot at each, and its label at the end.
std::string curve(const ConvergenceSeries& series, const Scale& x, const Scale& y, std::size_t number) {
  std::string path, dots;
  double last_x = 0, last_y = 0;
  for (std::size_t i = 0; i < series.values.size(); ++i) {
    if (!(series.values[i] > 0) || !std::isfinite(series.values[i])) continue;
    last_x = x(static_cast<double>(i)), last_y = y(std::log10(series.values[i]));
    path += fmt::format("{}{:.1f} {:.1f}", path.empty() ? "M" : "L", last_x, last_y);
    if (series.values.size() <= 60)
      dots += fmt::format("<circle cx=\"{:.1f}\" cy=\"{:.1f}\" r=\"3.5\" class=\"dot-{}\"/>\n", last_x,
                          last_y, number);
  }
  return fmt::format("<path d=\"{}\" class=\"curve-{}\"/>\n{}", path, number, dots);
}

std::string key(const std::vector<ConvergenceSeries>& series) {
  std::string rows;
  for (std::size_t k = 0; k < series.size(); ++k) {
    const double y = top + 12 + 22 * static_cast<double>(k);
    rows += fmt::format("<path d=\"M{:.1f} {:.1f}h22\" class=\"curve-{}\"/>\n", right - 22, y, k);
    rows += text(right - 30, y + 5, "end", series[k].label);
  }
  return rows;
}

}  // namespace

std::string histogram_svg(const HistogramChart& chart) {
  const double total = std::accumulate(chart.counts.begin(), chart.counts.end(), 0.0);
  if (!(total > 0) || chart.edges.size() != chart.counts.size() + 1) return {};
  const double tallest = 100 * *std::max_element(chart.counts.begin(), chart.counts.end()) / total;
  const double step = tick_step(tallest);
  const Scale x = {chart.edges.front(), chart.edges.back(), left, right};
  const Scale y = {0, std::ceil(tallest / step) * step, bottom, top};

  std::string svg = open_svg("Histogram of the area ratio of the triangles");
  for (double percent = 0; percent <= y.to * 1.001; percent += step)
    svg += y_tick(y(percent), fmt::format("{:g}%", percent));
  for (std::size_t k = 0; k < chart.counts.size(); ++k) {
    const double from = x(chart.edges[k]), to = x(chart.edges[k + 1]), share = 100 * chart.counts[k] / total;
    const bool open = k == 0 || k + 1 == chart.counts.size();
    svg += fmt::format("<path d=\"M{:.2f} {:.1f}V{:.2f}H{:.2f}V{:.1f}Z\" class=\"{}\"/>\n", from + 0.4,
                       bottom, y(share), to - 0.4, bottom, open ? "bar open" : "bar");
  }
  for (int power = -6; power <= 6; power += 2) svg += x_tick(x(power), power_of_two(power));
  svg += line(x(0), bottom, x(0), top, "mark") + line(left, bottom, right, bottom, "axis");
  return svg + x_title("share of the tile's area / share of the source's") + "</svg>";
}

std::string convergence_svg(const std::vector<ConvergenceSeries>& series) {
  const auto range = decades(series);
  if (!range) return {};
  const auto [low, high] = *range;
  std::size_t count = 2;
  for (const ConvergenceSeries& one : series) count = std::max(count, one.values.size());
  const double last = static_cast<double>(count - 1);
  const Scale x = {0, last, left + 8, right - 8};
  const Scale y = {static_cast<double>(low), static_cast<double>(high), bottom, top};

  std::string svg = open_svg("Convergence of the optimiser, on a logarithmic axis");
  const int stride = std::max(1, (high - low + 4) / 5);
  for (int decade = low; decade <= high; decade += stride)
    svg += y_tick(y(decade), fmt::format("1e{}", decade));
  const int step = std::max(1, static_cast<int>(std::lround(tick_step(last))));
  for (int i = 0; i <= static_cast<int>(last); i += step) svg += x_tick(x(i), std::to_string(i));
  svg += line(left, bottom, right, bottom, "axis");
  for (std::size_t k = 0; k < series.size(); ++k) svg += curve(series[k], x, y, k);
  return svg + key(series) + x_title("iteration") + "</svg>";
}

std::string bar_svg(double share) {
  return fmt::format(
      "<svg class=\"share\" aria-hidden=\"true\"><rect width=\"{:.1f}%\" height=\"100%\"/></svg>",
      100 * std::clamp(share, 0.0, 1.0));
}

}  // namespace orbitutte
