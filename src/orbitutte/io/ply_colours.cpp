// SPDX-License-Identifier: MIT
#include "orbitutte/io/ply_colours.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/io/ply_header.h"
#include "orbitutte/types.h"

namespace orbitutte {

std::optional<PlyChannels> find_channels(const PlyElement& vertex) {
  constexpr std::array names = {"red", "green", "blue"};
  PlyChannels channels;
  for (std::size_t k = 0; k < names.size(); ++k) channels[k] = vertex.find(names[k]);
  if (std::count(channels.begin(), channels.end(), nullptr) == 3) return std::nullopt;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (channels[k] != nullptr && !channels[k]->is_list) continue;
    throw MeshError(fmt::format(
        "the element 'vertex' has colours without a number '{}'; export the file again", names[k]));
  }
  return channels;
}

double channel_value(const PlyProperty& channel, double value, std::size_t vertex) {
  const double full = is_integer(channel.type) ? 255 : 1;
  if (value >= 0 && value <= full) return value / full;
  throw MeshError(fmt::format("vertex {} has the {} {}, which is not within 0 .. {}; export the file again",
                              vertex, channel.name, value, full));
}

}  // namespace orbitutte
