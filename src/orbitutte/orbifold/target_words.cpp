// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/target_words.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {

std::string group_text(const Target& target) {
  if (!tiles_its_space(target)) return "no group";
  if (target.group_order > 0) return fmt::format("group of order {}", target.group_order);
  return target.space.is_closed() ? "finite group" : "infinite group";
}

std::string text_of(Space space) {
  if (space.is_closed()) return "the sphere";
  return space == Space::plane() ? "the Euclidean plane" : "the hyperbolic plane";
}

std::string place_in(Space space) {
  if (space.is_closed()) return "on the sphere";
  return space == Space::plane() ? "in the plane" : "in the hyperbolic plane";
}

std::string drawn_in(Space space) {
  return space == Space::hyperbolic_plane() ? "in Poincaré's disk" : place_in(space);
}

std::string text_of(Topology topology) {
  if (topology == Topology::other) return "surface of another kind";
  std::string text = name_of(topology);
  std::replace(text.begin(), text.end(), '-', ' ');
  return text;
}

}  // namespace orbitutte
