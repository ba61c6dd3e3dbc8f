// SPDX-License-Identifier: MIT
// The start of the optimiser (appendix B).
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

/// Positions (n x 3) of the input vertices in the space. The boundary's vertices stand first on the tile's
/// arcs at the arc length of their path on the source mesh, then move to where what both sides of a seam pull
/// at them balances; the rest is harmonic in the stereographic picture of the tile from its centroid
/// (LaplacianSolver::settle).
Points initial_embedding(const Surface& surface, const CutMesh& cut, const Tile& tile,
                         const BoundaryConditions& boundary, const LaplacianSolver& laplacian);

}  // namespace orbitutte
