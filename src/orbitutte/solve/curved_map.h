// SPDX-License-Identifier: MIT
// The shape of a tile on the sphere or in the hyperbolic plane and the harmonic map onto it, together: of all
// shapes, the one for which the map is conformal.
#pragma once

#include <vector>

#include "orbitutte/orbifold/braid.h"
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

/// The cones of a tile (k x 3), in the order in which the boundary of a cut mesh meets them, and positions of
/// the input vertices (n x 3).
struct TiledPositions {
  Points cones, x;
};

/// A surface that shares its tile with others. Where theirs meet the cones at p (k x 3), the boundary of its
/// cut mesh meets them at braided(p, braid).
struct TileSharer {
  const GluingProblem& problem;
  Braid braid;
};

/// Where the search for a shared tile begins.
struct SharedStart {
  /// Of the tile, for an empty braid.
  Points cones;

  /// Of each surface: n x 3.
  std::vector<Points> x;

  /// Is it the tile of these cones that all are mapped onto?
  bool is_tile_held = false;
};

/// A map of the surface onto its own conformal tile, up to what the triangles differ from a smooth surface:
/// that from which curved_map starts, or, if there is none, curved_map itself. Throws as curved_map does.
TiledPositions own_tile(const GluingProblem& problem, const LbfgsOptions& options, const Stages& stage);

/// The tile that depends on the target alone, a polygon with an inscribed circle, doubled, with a first map
/// onto it.
TiledPositions polygon_tile(const GluingProblem& problem);

/// Minimises the sum of the energies of surfaces that are mapped onto one tile, over the positions of each
/// and, unless the tile is held, its shape: a minimum for each. All have the same target and as many sides,
/// and their cuts meet the marks in one order, up to the braids. Throws as curved_map does.
std::vector<Minimum> maps_sharing_a_tile(const std::vector<TileSharer>& sharers, const SharedStart& start,
                                         const LbfgsOptions& options, const Stages& stage);

}  // namespace orbitutte
