// SPDX-License-Identifier: MIT
// The Hessian of the energy at a map, in orthonormal frames of the tangent planes.
#pragma once

#include <memory>

#include "orbitutte/linear/dissection.h"
#include "orbitutte/linear/laplacian_matrix.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/solve/boundary_conditions.h"
#include "orbitutte/solve/dirichlet_energy.h"
#include "orbitutte/solve/preconditioner.h"

namespace orbitutte {

/// What a tangent system is made of.
struct TangentProblem {
  const GluedEdges& glued;
  const Eigen::VectorXd& w;
  const BoundaryConditions& boundary;

  /// Of the graph of the edges.
  const Dissection& dissection;
  Backend backend;
};

/// Factorises the second derivative of E = sum of w d(p, q)^2, q = g x_j, along geodesics. For an edge with
/// unit tangents e_p and e_q along it at its ends, and n_p, n_q normal to it,
///     2 w ((e_q . dq - e_p . dp)^2 + A ((n_p . dp)^2 + (n_q . dq)^2) - 2 B (n_p . dp)(n_q . dq)),
/// with A = d ct d and B = d/sn d. In the hyperbolic plane A > B > 0, so the form is positive definite. If it
/// is not so on the sphere, A = B = 1 take the place of both: the Laplacian of the frames.
///
/// The glued Laplacian of R^3 (LaplacianSolver), which takes less time, serves only near (0, 0, 1) in the
/// hyperbolic plane, whose coordinates grow with the exponential of the distance from there.
class TangentSystem : public Preconditioner {
 public:
  /// At positions x (n x 3) of the input vertices; those that are held have no unknowns, all others may move
  /// in the whole space. Throws MeshError naming a vertex that no positive weight ties to the cones.
  TangentSystem(const TangentProblem& problem, const Points& x);
  ~TangentSystem() override;

  /// The inverse Hessian times a covector at x, as DirichletEnergy has gradients: tangent vectors at x.
  Points precondition(const Points& gradient) const override;

  /// Is it the second derivative itself?
  bool is_exact() const { return is_exact_; }

 private:
  using Frame = Eigen::Matrix<double, 3, 2>;

  SparseMatrix assemble_hessian(const TangentProblem& problem, const Points& x, bool is_exact) const;

  std::vector<Frame> frames_;
  Unknowns unknowns_;
  std::unique_ptr<SparseFactor> factor_;
  bool is_exact_ = true;
};

}  // namespace orbitutte
