// SPDX-License-Identifier: MIT
// The start of the optimiser (appendix B).
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

/// Unit positions (n x 3) of the input vertices: the boundary's vertices stand on the tile's arcs at the arc
/// length of their path on the source mesh, the rest is a planar Tutte embedding of the tile's orthographic
/// projection from its centroid, lifted back to the sphere.
Points initial_embedding(const Surface& surface, const CutMesh& cut, const Tile& tile,
                         const BoundaryConditions& boundary, const LaplacianSolver& laplacian);

}  // namespace orbitutte
