// SPDX-License-Identifier: MIT
#include "orbitutte/io/ply_colours.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/io/ply_header.h"

namespace orbitutte {

PlyChannels find_channels(const PlyElement& vertex) {
  constexpr std::array names = {"red", "green", "blue"};
  PlyChannels result;
  for (std::size_t k = 0; k < names.size(); ++k) result.channel[k] = vertex.find(names[k]);
  if (std::count(result.channel.begin(), result.channel.end(), nullptr) == 3) return result;
  for (std::size_t k = 0; k < names.size(); ++k) {
    if (result.channel[k] != nullptr && !result.channel[k]->is_list) continue;
    return {{}, fmt::format("the element 'vertex' has colours without a number '{}'", names[k])};
  }
  return result;
}

VertexColours colours_of_channels(const PlyChannels& channels, const Points& values) {
  const bool are_bytes = std::all_of(channels.channel.begin(), channels.channel.end(),
                                     [](const PlyProperty* channel) { return is_integer(channel->type); });
  return are_bytes ? colours_of_bytes(values) : colours_of_numbers(values);
}

}  // namespace orbitutte
