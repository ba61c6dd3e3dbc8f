// SPDX-License-Identifier: MIT
#include "orbitutte/types.h"

namespace orbitutte {

std::string name(Topology topology) {
  switch (topology) {
    case Topology::sphere:
      return "sphere";
    case Topology::disk:
      return "disk";
    case Topology::projective_plane:
      return "projective-plane";
    case Topology::other:
      return "other";
  }
  return {};
}

}  // namespace orbitutte
