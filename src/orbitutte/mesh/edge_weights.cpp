// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/edge_weights.h"

namespace orbitutte {

std::string name(WeightKind kind) {
  switch (kind) {
    case WeightKind::standard:
      return "standard";
    case WeightKind::cotan:
      return "cotan";
    case WeightKind::delaunay:
      return "delaunay";
    case WeightKind::mean_value:
      return "mean-value";
    case WeightKind::uniform:
      return "uniform";
    case WeightKind::file:
      return "file";
  }
  return {};
}

}  // namespace orbitutte
