// SPDX-License-Identifier: MIT
// Faces that a mirror or a held side flattens.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "orbitutte/solve/boundary_conditions.h"

namespace orbitutte {

/// A face with all edges but one on one mirror or held side, as a triangle with two of them, seen from one of
/// its tips. All its vertices stay on the side's great circle, so its image is an arc and its area zero,
/// whatever the weights.
struct Ear {
  int face = -1;
  /// A vertex between two edges on the side, which belongs to no other face.
  int tip = -1;
  /// The face's vertices between which its tips lie, cut vertices.
  std::array<int, 2> ends = {-1, -1};
  /// The side's unit normal, away from the tile.
  Vector3 outward = Vector3::Zero();
};

/// The tips of all such faces, side by side of the tile, and along each side. faces: those of the cut mesh.
std::vector<Ear> find_ears(const FaceView& faces, const Tile& tile, const BoundaryConditions& boundary);

/// How many faces the tips belong to.
int count_faces(const std::vector<Ear>& ears);

/// How far round_outward moves a tip: a few units in the last place, and less than the certificate lets pass
/// for rounding, whatever edges there are.
constexpr double outward_rounding = 4 * std::numeric_limits<double>::epsilon();

/// Rounds the tips of the ears outwards from their mirrors and sides, by a few units in the last place. They
/// stay as near to the great circle as rounding allows, and the stored faces are always positively oriented.
/// positions: n x 3.
void round_outward(const std::vector<Ear>& ears, Points& positions);

}  // namespace orbitutte
