// SPDX-License-Identifier: MIT
// Numbers of scenes as JSON: base64 of little-endian numbers, which viewer/src/scene_data.js decodes. Private
// to page/.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/report/colour_scale.h"

namespace orbitutte {

/// Base64 of count numbers, `number(i)` each, lowest byte first.
template <typename Number>
std::string packed(Eigen::Index count, const Number& number) {
  std::string bytes;
  bytes.reserve(static_cast<std::size_t>(count) * sizeof(number(0)));
  for (Eigen::Index i = 0; i < count; ++i) append_little_endian(bytes, number(i));
  return base64(bytes);
}

/// A number between `low` and `low + size` as 16 bits.
std::uint16_t quantised(double value, double low, double size);

/// Numbers between bounds as 16 bits each.
struct ValueRange {
  double low = 0, high = 1;

  std::uint16_t operator()(double value) const { return quantised(value, low, high - low); }
};

/// That of some values; 0 .. 1 if there are none.
ValueRange range_of(const std::vector<double>& values);
nlohmann::ordered_json range_json(const ValueRange& range);

/// `low`, `high`, `title`, `ticks` (`at`: 0 .. 1 along the scale, `text`), and 256 `colours`.
nlohmann::ordered_json scale_json(const ColourScale& scale);

}  // namespace orbitutte
