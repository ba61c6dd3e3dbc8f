// SPDX-License-Identifier: MIT
// The minimiser of the energy (2) over all ways to glue a mesh that is cut open along the sides of a tile.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/progress.h"
#include "orbitutte/solve/boundary_arcs.h"
#include "orbitutte/solve/lbfgs.h"

namespace orbitutte {

/// A surface cut open, and a tile that its boundary is glued to.
struct GluingProblem {
  const Surface& surface;
  const CutMesh& cut;
  const Orbifold& orbifold;
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
};

/// The edges that have the weights, glued along the boundary: the surface's, or those of the triangulation
/// that has them.
GluedEdges glued_along(const GluingProblem& problem, const BoundaryConditions& boundary);

/// Equations (3), (4) and (7), and the sides that theorem 1 holds.
BoundaryConditions boundary_conditions(const Surface& surface, const CutMesh& cut, const Tile& tile,
                                       const Orbifold& orbifold, Spread spread);

/// On the sphere: factorises, starts (appendix B), minimises (algorithm 1, with `options`, whose callback is
/// not called), and turns what is free to turn: about the axis of NN, *NN and N* to longitude 0 of the vertex
/// nearest to the equator, and, where edges are tiny, to a frame that resolves them. In the plane: one linear
/// solve. Throws MeshError where an edge joins marked vertices whose images are opposite to each other.
Placement place(const GluingProblem& problem, const LbfgsOptions& options, Stages& stage);

}  // namespace orbitutte
