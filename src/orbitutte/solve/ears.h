// SPDX-License-Identifier: MIT
// Faces that a mirror flattens.
#pragma once

#include <vector>

#include "orbitutte/solve/boundary_conditions.h"

namespace orbitutte {

/// A face with all edges but one on one mirror, as a triangle with two of them, seen from one of its tips.
/// All its vertices stay on the mirror's great circle, so its image is an arc and its area zero, whatever the
/// weights.
struct Ear {
  int face = -1;
  int tip = -1;  ///< a vertex between two edges on the mirror, which belongs to no other face
  Vector3 outward = Vector3::Zero();  ///< the mirror's unit normal, away from the tile
};

/// The tips of all such faces, side by side of the tile, and along each side. faces: those of the cut mesh.
std::vector<Ear> find_ears(const FaceView& faces, const Tile& tile, const BoundaryConditions& boundary);

/// How many faces the tips belong to.
int count_faces(const std::vector<Ear>& ears);

/// Rounds the tips of the ears to the outer side of their mirrors, by a few units in the last place: as near
/// to the great circle as any rounded point of it, and the stored face is positively oriented instead of
/// by chance. positions: n x 3.
void round_outward(const std::vector<Ear>& ears, Points& positions);

}  // namespace orbitutte
