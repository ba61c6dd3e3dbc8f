// SPDX-License-Identifier: MIT
// Two ways to the two linear systems of LaplacianSolver. Private to solve/.
#pragma once

#include <memory>

#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

/// The cut disk with its gluing, as the systems see it.
struct LaplacianProblem {
  const CutMesh& cut;
  const GluedEdges& glued;
  const Eigen::VectorXd& w;
  const BoundaryConditions& boundary;
  const std::vector<char>&
      inside;              ///< n: is the vertex inside the cut disk, not on its boundary, and used by a face?
  std::vector<int> order;  ///< n: a fill-reducing elimination order
};

class LaplacianSystems {
 public:
  virtual ~LaplacianSystems() = default;

  /// Solves the scalar Laplacian of the vertices inside, all others held at zero; f and the result: n_cut x
  /// d, of which only the rows of vertices inside count.
  virtual Eigen::MatrixXd solve_disk(const Eigen::MatrixXd& f) const = 0;

  /// Solves the glued Laplacian; f and the result: n x 3, feasible.
  virtual Points solve_glued(const Points& f) const = 0;
};

/// One factorisation of the cut disk's scalar Laplacian, its banks last. Away from the banks the three
/// coordinates do not couple, so the leading part of the factor serves both systems, and the trailing Schur
/// complement S (the disk's Dirichlet-to-Neumann matrix on the banks) is glued into one small dense matrix
/// N'(S x I3)N. For banks that are short beside the mesh.
std::unique_ptr<LaplacianSystems> banked_systems(const LaplacianProblem& problem, Backend backend);

/// Each system sparse and on its own: a scalar one, and one of up to three unknowns a vertex. For banks of
/// any length.
std::unique_ptr<LaplacianSystems> coupled_systems(const LaplacianProblem& problem, Backend backend);

}  // namespace orbitutte
