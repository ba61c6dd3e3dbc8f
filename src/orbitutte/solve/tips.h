// SPDX-License-Identifier: MIT
// The tips of limbs, where cones of more than pi turn faces over.
#pragma once

#include <vector>

#include "orbitutte/solve/repair.h"

namespace orbitutte {

/// Places the vertices around a cone anew, within the least number of rings of neighbours that makes all
/// faces there positive. Near a cone of the angle 2 pi a, a harmonic map is A z^a + B conj(z)^(1 - a) in a
/// conformal coordinate z of the surface: for a > 1/2 the second part, which reverses orientations, shrinks
/// more slowly towards the cone than the first, however small it was (docs/limits.md). Unrolled by the root w
/// = x^(1/a) of positions x around the cone, the neighbourhood is a disk in the plane: the ring around it is
/// held there, the cone is held at zero, and what lies between is Tutte's embedding.
///
/// The vertices that moved, ascending; none if no number of rings makes more faces positive than are.
std::vector<int> unroll_tip(const RepairSite& site, const ConeCopies& cone, MovablePositions& positions);

/// The same at all cones of more than pi with faces that are not positive beside them or beside their
/// neighbours.
std::vector<int> unroll_tips(const RepairSite& site, MovablePositions& positions);

}  // namespace orbitutte
