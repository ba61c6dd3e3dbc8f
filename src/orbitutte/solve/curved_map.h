// SPDX-License-Identifier: MIT
// The shape of a tile on the sphere or in the hyperbolic plane and the harmonic map onto it, together: of all
// shapes, the one for which the map is conformal.
#pragma once

#include "orbitutte/solve/placement.h"

namespace orbitutte {

/// Minimises the energy (2) over the positions and the shapes of a curved tile whose shape is free, of a
/// sphere or a disk that is cut along a tree. The positions of the result are those for the tile that
/// tile_through makes of them; `shapes` has a row for each tile: the energy, the largest derivative by a unit
/// step of its shape, and the length of the step that led there.
///
/// Variable projection (G. H. Golub, V. Pereyra, "The differentiation of pseudo-inverses and nonlinear least
/// squares problems whose variables separate", SIAM J. Numer. Anal. 10 (1973)): on each tile the positions x
/// are those of the harmonic map, which leaves E as a function of the shape m alone, with the Hessian
///     S = E_mm - E_mx E_xx^-1 E_xm,
/// and trust-region steps in m take x along by -E_xx^-1 E_xm. S is indefinite far from the minimum, where
/// minimising over both at once stalls.
///
/// The first tile and map are the surface with its discretely conformal metric (conformal_metric), developed;
/// they are so near to the last that a few tiles share one factorisation. If there is no such metric, the
/// first tile is made from a polygon (Moduli); on the sphere, whose harmonic maps of large area are many, the
/// area of the target then grows in steps, all deficits of angles being scaled.
///
/// problem: its tile is any of the target's. Throws MeshError if doubles do not hold the tile, and Cancelled.
Minimum curved_map(const GluingProblem& problem, const LbfgsOptions& options, const Stages& stage);

}  // namespace orbitutte
