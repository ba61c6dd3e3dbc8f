// SPDX-License-Identifier: MIT
// Triangles that a mirror or a held side flattens.
#pragma once

#include <vector>

#include "orbitutte/solve/boundary_conditions.h"

namespace orbitutte {

/// A triangle with two edges on one mirror or held side. All three vertices stay on its great circle, so the
/// image is an arc and its area zero, whatever the weights.
struct Ear {
  int face = -1;
  int tip = -1;                       ///< the vertex between the two edges, which belongs to no other face
  Vector3 outward = Vector3::Zero();  ///< the side's unit normal, away from the tile
};

std::vector<Ear> find_ears(const CutMesh& cut, const Tile& tile, const BoundaryConditions& boundary);

/// Rounds the tips of the ears outwards from their mirrors and sides, by a few units in the last place: as
/// near to the great circle as any rounded point of it, and the stored triangle is positively oriented
/// instead of by chance. positions: n x 3.
void round_outward(const std::vector<Ear>& ears, Points& positions);

}  // namespace orbitutte
