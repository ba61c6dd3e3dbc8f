// SPDX-License-Identifier: MIT
// Where in the space the tile lies: a choice that changes no length, but what doubles can resolve.
#pragma once

#include <optional>

#include "orbitutte/solve/boundary_conditions.h"
#include "orbitutte/solve/dirichlet_energy.h"

namespace orbitutte {

/// An isometry that takes the place where the map shrinks most to (0, 0, 1), where two coordinates are small
/// and so have small rounding errors: a limb that shrinks below the resolution elsewhere is resolved there.
/// Nothing if no edge is shorter than 1e-7.
std::optional<Isometry> resolving_frame(const DirichletEnergy& energy, const Points& positions);

/// The positions in the frame, the parts that shrink settled again at the finer resolution: `energy` and
/// `boundary` are those of the moved tile.
Points settle_in_frame(const Points& positions, const Isometry& frame, const DirichletEnergy& energy,
                       const BoundaryConditions& boundary);

}  // namespace orbitutte
