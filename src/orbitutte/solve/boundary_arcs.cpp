// SPDX-License-Identifier: MIT
#include "orbitutte/solve/boundary_arcs.h"

namespace orbitutte {
namespace {

std::vector<double> equal_fractions(std::size_t count) {
  std::vector<double> at(count);
  for (std::size_t k = 0; k < count; ++k) at[k] = static_cast<double>(k) / static_cast<double>(count - 1);
  return at;
}

}  // namespace

std::vector<double> arc_fractions(const std::vector<int>& side, const Surface& surface,
                                  const std::vector<int>& source, Spread spread) {
  std::vector<double> equal = equal_fractions(side.size());
  if (spread == Spread::equidistant) return equal;
  std::vector<double> at = {0};
  for (std::size_t k = 1; k < side.size(); ++k)
    at.push_back(at.back() + (surface.V.row(source[side[k]]) - surface.V.row(source[side[k - 1]])).norm());
  const double total = at.back();
  for (std::size_t k = 0; k < at.size(); ++k)
    at[k] = total > 0 ? 0.999 * at[k] / total + 0.001 * equal[k] : equal[k];
  return at;
}

void hold_sides(const Surface& surface, const CutMesh& cut, const Tile& tile, Spread spread,
                BoundaryConditions& boundary) {
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    if (!tile.sides[s].held()) continue;
    const std::vector<int>& side = boundary.sides[s];
    const std::vector<double> at = arc_fractions(side, surface, cut.source_vertex, spread);
    for (std::size_t k = 1; k + 1 < side.size(); ++k) {
      boundary.basis_of[side[k]] = held_in_place;
      boundary.held[side[k]] = tile.space().retract(tile.sides[s].point(at[k] * tile.sides[s].length));
    }
  }
}

}  // namespace orbitutte
