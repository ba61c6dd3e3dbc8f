// SPDX-License-Identifier: MIT
#include "orbitutte/page/scene_numbers.h"

#include <utility>

#include "orbitutte/export/palette.h"

namespace orbitutte {

std::uint16_t quantised(double value, double low, double size) {
  constexpr double largest_uint16 = 65535;
  return static_cast<std::uint16_t>(std::lround(std::clamp((value - low) / size, 0.0, 1.0) * largest_uint16));
}

ValueRange range_of(const std::vector<double>& values) {
  if (values.empty()) return {};
  const auto [low, high] = std::minmax_element(values.begin(), values.end());
  return {*low, std::max(*high, *low + 1e-6)};
}

nlohmann::ordered_json range_json(const ValueRange& range) { return {range.low, range.high}; }

nlohmann::ordered_json scale_json(const ColourScale& scale) {
  constexpr int steps = 256;
  nlohmann::ordered_json ticks = nlohmann::ordered_json::array(), colours = nlohmann::ordered_json::array();
  for (const ChartTick& tick : scale.axis.ticks)
    ticks.push_back({{"at", share_along(scale.axis, tick.at)}, {"text", tick.text}});
  for (const Rgb& colour : scale_colours(scale.measure, steps)) colours.push_back(hexadecimal(colour));
  return {{"low", scale.axis.low},
          {"high", scale.axis.high},
          {"title", scale.axis.title},
          {"ticks", std::move(ticks)},
          {"colours", std::move(colours)}};
}

}  // namespace orbitutte
