// SPDX-License-Identifier: MIT
// The minimiser of the energy (2) over all ways to glue a mesh that is cut open along the sides of a tile.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/progress.h"
#include "orbitutte/solve/boundary_arcs.h"
#include "orbitutte/solve/laplacian_solver.h"
#include "orbitutte/solve/lbfgs.h"

namespace orbitutte {

/// A surface cut open, and a tile that its boundary is glued to.
struct GluingProblem {
  const Surface& surface;
  const CutMesh& cut;
  const Target& target;
  const EdgeWeights& weights;
  LaplacianSetup laplacian;
  Tile tile;
  BoundaryConditions boundary;
};

/// The minimiser, and the tile and its gluing in the frame where it lies.
struct Placement {
  Minimum minimum;
  Tile tile;
  BoundaryConditions boundary;

  /// Takes the target's canonical frame to the one where the positions lie.
  Isometry frame;
};

/// The edges that have the weights, glued along the boundary: the surface's, or those of the triangulation
/// that has them.
GluedEdges glued_along(const GluingProblem& problem, const BoundaryConditions& boundary);

/// The energy (2) of a map that was placed, its positions in doubles.
double energy_of(const GluingProblem& problem, const Placement& placed);

/// Equations (3), (4) and (7), and the sides that theorem 1 holds.
BoundaryConditions boundary_conditions(const Surface& surface, const CutMesh& cut, const Tile& tile,
                                       const Target& target, Spread spread);

/// Takes the canonical frame of a target with a free tile, where the first mark lies at (0, 0, 1) and the
/// second in the direction of x, to that of the positions.
Isometry frame_of_marks(const GluingProblem& problem, const Points& positions);

/// The same moved by an isometry that keeps orientations, its frame with it.
Placement moved(const GluingProblem& problem, const Isometry& isometry, const Placement& placed);

/// Factorises, starts (appendix B) and minimises (algorithm 1, with `options`, whose callback is not called).
/// A map that the target leaves free to rotate is turned so that one vertex has longitude 0. If the tile is
/// free, `problem` has any of the target's: the map starts as conformal_map has it, or, on a curved tile, is
/// curved_map; the tile becomes its own, with the first mark at (0, 0, 1) and the second in the direction of
/// x, in the canonical frame. Throws MeshError if an edge joins
/// marked vertices whose images are opposite to each other.
Placement place(const GluingProblem& problem, const LbfgsOptions& options, Stages& stage);

}  // namespace orbitutte
