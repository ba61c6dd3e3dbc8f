// SPDX-License-Identifier: MIT
#include "orbitutte/render/colour_table.h"

#include <algorithm>
#include <cmath>

namespace orbitutte {
namespace {

constexpr int last_of_table = 4096;

}  // namespace

ColourTable::ColourTable(const ColourScale& scale) : scale_(scale) {
  colours_.reserve(last_of_table + 1);
  for (int k = 0; k <= last_of_table; ++k)
    colours_.push_back(scale_colour(scale.measure, static_cast<double>(k) / last_of_table));
}

const Colour& ColourTable::at(double value) const {
  const double share = share_along(scale_.axis, value);
  if (std::isnan(share)) return unmeasured_;
  return colours_[std::lround(last_of_table * std::clamp(share, 0.0, 1.0))];
}

}  // namespace orbitutte
