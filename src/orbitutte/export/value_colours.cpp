// SPDX-License-Identifier: MIT
#include "orbitutte/export/value_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <unordered_map>

#include "orbitutte/export/palette.h"
#include "orbitutte/io/text_scanner.h"

namespace orbitutte {
namespace {

const Eigen::RowVector3d no_value_grey(0.6, 0.6, 0.6);

// At the share t, 0 .. 1, of the scale between two values. Where zero lies between them, it is in the middle.
Rgb value_colour(double low, double high, double t) {
  return srgb(low < 0 && high > 0 ? diverging_colour(2 * t - 1) : sequential_colour(t));
}

Eigen::RowVector3d shown_colour(const Rgb& rgb) {
  return Eigen::RowVector3d(rgb.red, rgb.green, rgb.blue) / 255;
}

ValueColours label_colours(const VertexData& data, Eigen::Index map) {
  std::unordered_map<double, Eigen::RowVector3d> colours;
  for (const ValueLabel& label : data.labels)
    colours.emplace(label.key, Eigen::RowVector3d(label.colour[0], label.colour[1], label.colour[2]));
  ValueColours result;
  result.colours.resize(data.values.rows(), 3);
  for (Eigen::Index v = 0; v < data.values.rows(); ++v) {
    const auto colour = colours.find(data.values(v, map));
    result.colours.row(v) =
        colour == colours.end() ? no_value_grey : colour->second.cwiseMax(0.0).cwiseMin(1.0);
  }
  return result;
}

// The values that a hundredth falls short of and exceeds; equal if all are.
std::pair<double, double> inner_range(const VertexData& data, Eigen::Index map) {
  std::vector<double> values;
  values.reserve(static_cast<std::size_t>(data.values.rows()));
  for (const double value : data.values.col(map))
    if (std::isfinite(value)) values.push_back(value);
  if (values.empty()) return {0, 0};
  std::sort(values.begin(), values.end());
  const std::size_t left_out = values.size() / 100;
  return {values[left_out], values[values.size() - 1 - left_out]};
}

ValueColours measure_colours(const VertexData& data, Eigen::Index map) {
  ValueColours result;
  std::tie(result.low, result.high) = inner_range(data, map);
  if (result.low < 0 && result.high > 0) {
    result.high = std::max(-result.low, result.high);
    result.low = -result.high;
  }
  result.colours.resize(data.values.rows(), 3);
  const double size = result.high > result.low ? result.high - result.low : 1;
  for (Eigen::Index v = 0; v < data.values.rows(); ++v) {
    const double t = (data.values(v, map) - result.low) / size;
    result.colours.row(v) =
        std::isfinite(t) ? shown_colour(value_colour(result.low, result.high, t)) : no_value_grey;
  }
  return result;
}

}  // namespace

Eigen::Index find_map(const VertexData& data, const std::string& name_or_number) {
  const auto name = std::find(data.names.begin(), data.names.end(), name_or_number);
  if (name != data.names.end()) return name - data.names.begin();
  int number = 0;
  if (parse_number(name_or_number, number) == NumberError::none && number >= 0 && number < data.values.cols())
    return number;
  throw ArgumentError(fmt::format(
      "there is no map {}; the maps are 0 .. {}{}", in_quotes(name_or_number), data.values.cols() - 1,
      data.names.empty() ? "" : fmt::format(": {}", shown(fmt::format("{}", fmt::join(data.names, ", "))))));
}

ValueColours value_colours(const VertexData& data, Eigen::Index map) {
  return data.labels.empty() ? measure_colours(data, map) : label_colours(data, map);
}

std::vector<Rgb> value_scale_colours(double low, double high, int count) {
  std::vector<Rgb> colours;
  colours.reserve(static_cast<std::size_t>(count));
  for (int k = 0; k < count; ++k) colours.push_back(value_colour(low, high, k / std::max(count - 1.0, 1.0)));
  return colours;
}

}  // namespace orbitutte
