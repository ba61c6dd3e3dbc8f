// SPDX-License-Identifier: MIT
#include "orbitutte/io/vertex_colours.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace orbitutte {

namespace {

constexpr double full_byte = 255;
constexpr double colour_rounding = 1e-3;  // above 1, as of numbers that were written with a few decimals

/// The first channel, vertex by vertex, that passes the test; the number of channels if none does.
template <class Test>
Eigen::Index first_channel(const Points& channels, const Test& test) {
  return std::find_if(channels.data(), channels.data() + channels.size(), test) - channels.data();
}

/// "vertex 3 has the colour channel 1.5"
std::string shown_channel(const Points& channels, Eigen::Index channel) {
  return fmt::format("vertex {} has the colour channel {}", channel / 3, channels.data()[channel]);
}

/// The channel that no colour can have, or the number of channels.
Eigen::Index first_out_of_range(const Points& channels) {
  return first_channel(channels, [](double c) { return !(c >= 0 && c <= full_byte); });
}

VertexColours out_of_range(const Points& channels, Eigen::Index channel) {
  return no_colours(shown_channel(channels, channel) + ", which is not within 0 .. 255");
}

}  // namespace

VertexColours no_colours(const std::string& reason) {
  return {Points(0, 3), reason + ": the colours of the vertices are ignored"};
}

VertexColours colours_of_bytes(const Points& channels) {
  const Eigen::Index wrong = first_out_of_range(channels);
  if (wrong < channels.size()) return out_of_range(channels, wrong);
  return {channels / full_byte, {}};
}

VertexColours colours_of_numbers(const Points& channels) {
  const Eigen::Index wrong = first_out_of_range(channels);
  if (wrong < channels.size()) return out_of_range(channels, wrong);
  const double largest = channels.size() > 0 ? channels.maxCoeff() : 0.0;
  if (largest <= 1) return {channels, {}};
  if (largest <= 1 + colour_rounding) {
    const Eigen::Index above = first_channel(channels, [](double c) { return c > 1; });
    return {channels.cwiseMin(1.0), shown_channel(channels, above) + ": values above 1 count as 1"};
  }
  const Eigen::Index fraction = first_channel(channels, [](double c) { return c != std::trunc(c); });
  if (fraction == channels.size()) return {channels / full_byte, {}};
  return {channels / full_byte, shown_channel(channels, fraction) +
                                    " and others are above 1: all are taken for numbers of 0 .. 255"};
}

void give_colours(VertexColours colours, PolygonMesh& mesh) {
  mesh.colours = std::move(colours.values);
  if (!colours.warning.empty()) mesh.warnings.push_back(std::move(colours.warning));
}

}  // namespace orbitutte
