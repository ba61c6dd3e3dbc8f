// SPDX-License-Identifier: MIT
// How the cones of a tile are met when the same surface is cut another way.
#pragma once

#include <numbers>
#include <vector>

#include "orbitutte/orbifold/moduli.h"

namespace orbitutte {

/// Exchanges what is met in two places that follow each other. With the rotations R_i about the cones, the
/// product R_j R_(j + 1) stays as it is:
///     forth: R_j' = R_(j + 1),                  R_(j + 1)' = R_(j + 1)^-1 R_j R_(j + 1);
///     back:  R_j' = R_j R_(j + 1) R_j^-1,       R_(j + 1)' = R_j.
struct HalfTwist {
  /// j, counted from 0.
  int place = 0;
  bool is_forth = true;

  bool operator==(const HalfTwist& other) const = default;
};

/// Half twists, the first to be applied first. Two cuts along paths through the same cones differ by one.
using Braid = std::vector<HalfTwist>;

/// What takes back all that the braid does.
Braid inverse(const Braid& braid);

/// The first braid, then the second, without neighbours that cancel.
Braid product(const Braid& first, const Braid& second);

/// The full twist of the places first < last around each other, all others being held: `last` goes in front
/// of those in between to `first` and once around it.
Braid full_twist(int first, int last, bool is_forth);

/// Where the cones (k x 3) are met once the braid was applied. All cones that it exchanges must have the same
/// angle.
Points braided(const Moduli& moduli, Points cones, const Braid& braid);

/// By what each of them was moved: in place i lies motions[i] * the position of the cone before the braid.
std::vector<Isometry> motions(const Moduli& moduli, Points cones, const Braid& braid);

/// The same as braided for cones of one angle in the plane, as a matrix (k x k) on their complex numbers x +
/// iy, whatever these are.
Eigen::MatrixXcd braid_matrix(int count, const Braid& braid, double angle = std::numbers::pi);

/// The same of cones that move.
VaryingMarks braided(VaryingMarks marks, const Braid& braid);

}  // namespace orbitutte
