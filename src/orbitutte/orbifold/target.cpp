// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/target.h"

#include <cmath>
#include <numbers>

namespace orbitutte {
namespace {

// The angle of an order of one.
double whole_angle(ConeKind kind) {
  return kind == ConeKind::rotation ? 2 * std::numbers::pi : std::numbers::pi;
}

}  // namespace

Mark Mark::of_order(int order, ConeKind kind) {
  return {kind == ConeKind::fixed ? 0.0 : whole_angle(kind) / order, kind};
}

int Mark::order() const {
  if (kind == ConeKind::fixed) return 1;
  if (!(angle > 0)) return 0;
  const double order = std::round(whole_angle(kind) / angle);
  return order >= 1 && std::abs(whole_angle(kind) / order - angle) < 1e-12 * angle ? static_cast<int>(order)
                                                                                   : 0;
}

}  // namespace orbitutte
