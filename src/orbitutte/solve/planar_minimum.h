// SPDX-License-Identifier: MIT
// The minimiser of the planar Dirichlet energy: Euclidean orbifold Tutte embeddings (N. Aigerman, Y. Lipman,
// "Orbifold Tutte embeddings", ACM TOG 34 (2015)).
#pragma once

#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

struct PlanarMinimum {
  Points positions;          ///< n x 3, in the plane z = 1
  double energy = 0;         ///< sum over edges of w_ij |p_i - g_ij p_j|^2
  double gradient_norm = 0;  ///< infinity norm of the feasible gradient
};

/// Minimises over all positions that the boundary conditions of a Euclidean tile allow. The energy is
/// quadratic, so one Newton step from any of them ends at the minimum, and a second, with the same factor,
/// takes its rounding errors away. Throws as LaplacianSolver does.
PlanarMinimum planar_minimum(const CutMesh& cut, const GluedEdges& glued, const EdgeWeights& weights,
                             const BoundaryConditions& boundary, const LaplacianSetup& setup);

}  // namespace orbitutte
