// SPDX-License-Identifier: MIT
#include "orbitutte/report/colour_scale.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "orbitutte/report/chart_numbers.h"

namespace orbitutte {
namespace {

// The first of some ends, ascending, that is no less than `wanted`, or else the last.
double round_end(double wanted, std::span<const double> ends) {
  const auto at = std::lower_bound(ends.begin(), ends.end(), wanted);
  return at == ends.end() ? ends.back() : *at;
}

ColourScale area_scale(const std::vector<double>& log_areas) {
  static constexpr double ends[] = {1, 2, 3, 4, 6};
  const double range = round_end(quantile_of_magnitudes(log_areas, 0.9), ends);
  ColourScale scale = {Measure::area, {area_axis_title, -range, range, octave_ticks(range)}};
  scale.axis.ticks.front().text.insert(0, "≤ ");
  scale.axis.ticks.back().text.insert(0, "≥ ");
  return scale;
}

ColourScale angle_scale(const std::vector<double>& ratios) {
  static constexpr double ends[] = {1.1, 1.2, 1.5, 2, 3, 5, 10};
  const double largest = round_end(quantile_of_magnitudes(ratios, 0.95), ends);
  ColourScale scale = {Measure::angle, {"angle distortion (ratio of singular values)", 1, largest, {}}};
  constexpr int steps = 4;
  for (int k = 0; k <= steps; ++k) {
    const double value = 1 + (largest - 1) * k / steps;
    scale.axis.ticks.push_back({value, fmt::format("{:.4g}", value)});
  }
  scale.axis.ticks.back().text.insert(0, "≥ ");
  return scale;
}

}  // namespace

double value_of(Measure measure, const FaceDistortion& face) {
  const double value = measure == Measure::area ? face.area : face.angle;
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  return measure == Measure::area ? std::log2(value) : value;
}

std::vector<double> values_of(Measure measure, const std::vector<FaceDistortion>& faces) {
  std::vector<double> values;
  values.reserve(faces.size());
  for (const FaceDistortion& face : faces)
    if (const double value = value_of(measure, face); !std::isnan(value)) values.push_back(value);
  return values;
}

ColourScale colour_scale(Measure measure, const std::vector<double>& values) {
  return measure == Measure::area ? area_scale(values) : angle_scale(values);
}

ColourScale common_colour_scale(Measure measure, const std::vector<std::vector<double>>& maps) {
  ColourScale widest = colour_scale(measure, {});
  for (const std::vector<double>& values : maps)
    if (ColourScale scale = colour_scale(measure, values); scale.axis.high > widest.axis.high)
      widest = std::move(scale);
  return widest;
}

}  // namespace orbitutte
