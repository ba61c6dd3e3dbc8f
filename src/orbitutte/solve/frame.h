// SPDX-License-Identifier: MIT
// Where on the sphere the tile lies: a choice that changes no length, but what doubles can resolve.
#pragma once

#include <optional>

#include "orbitutte/solve/spherical_energy.h"

namespace orbitutte {

/// A rotation that takes the place where the map shrinks most to a coordinate axis, where two coordinates of
/// a unit vector are small and so have small rounding errors: a limb that shrinks below the resolution
/// elsewhere is resolved there. Nothing where no edge is shorter than 1e-7.
std::optional<Matrix3> resolving_frame(const SphericalEnergy& energy, const Points& positions);

/// The positions in the frame, the parts that shrink settled again at the finer resolution: `energy` and
/// `boundary` are those of the rotated tile.
Points settle_in_frame(const Points& positions, const Matrix3& frame, const SphericalEnergy& energy,
                       const BoundaryConditions& boundary);

}  // namespace orbitutte
