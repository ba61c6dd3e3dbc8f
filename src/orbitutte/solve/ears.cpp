// SPDX-License-Identifier: MIT
#include "orbitutte/solve/ears.h"

#include <Eigen/Geometry>
#include <limits>

namespace orbitutte {

std::vector<Ear> find_ears(const CutMesh& cut, const Tile& tile, const BoundaryConditions& boundary) {
  std::vector<int> faces_at(cut.vertex_count(), 0), last_face(cut.vertex_count(), -1);
  for (int h = 0; h < static_cast<int>(cut.F.size()); ++h) {
    const int v = origin(cut.F, h);
    ++faces_at[v];
    last_face[v] = h / 3;
  }
  std::vector<Ear> ears;
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    if (!tile.sides[s].held() && tile.sides[s].partner != static_cast<int>(s)) continue;
    const std::vector<int>& side = boundary.sides[s];
    for (std::size_t k = 1; k + 1 < side.size(); ++k)
      if (faces_at[side[k]] == 1) ears.push_back({last_face[side[k]], side[k], -tile.sides[s].pole()});
  }
  return ears;
}

void round_outward(const std::vector<Ear>& ears, Points& positions) {
  constexpr double few_units = 8 * std::numeric_limits<double>::epsilon();
  for (const Ear& ear : ears) positions.row(ear.tip) += few_units * ear.outward.transpose();
}

}  // namespace orbitutte
