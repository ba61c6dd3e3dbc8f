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
/// unit tangents e_p and e_q along it at its ends, and n_p, n_q normal to it on the same side,
///     2 w ((e_q . dq - e_p . dp)^2 + A ((n_p . dp)^2 + (n_q . dq)^2) - 2 B (n_p . dp)(n_q . dq)),
/// with A = d ct d and B = d/sn d. In the hyperbolic plane A > B > 0, so the form is positive definite. If it
/// is not so on the sphere, A = B = 1 take the place of both: the Laplacian of the frames.
///
/// The glued Laplacian of R^3 (LaplacianSolver), which takes less time, serves only near (0, 0, 1) in the
/// hyperbolic plane, whose coordinates grow with the exponential of the distance from there.
///
/// The factor is in single precision, which is enough for a preconditioner. Where some weights are so large
/// that it is not (stiff_weight), each solution is refined once.
class TangentSystem : public Preconditioner {
 public:
  /// At positions x (n x 3) of the input vertices; those that are held have no unknowns, all others may move
  /// in the whole space. Throws MeshError naming a vertex that no positive weight ties to the cones.
  TangentSystem(const TangentProblem& problem, const Points& x);

  /// The same factor between frames at other positions, moved there along geodesics: a preconditioner for
  /// maps nearby, onto the same tile or one of almost the same shape.
  TangentSystem moved_to(const Points& x) const;

  /// The Hessian at other positions, of a map nearby, with the factor as its preconditioner.
  TangentSystem beside(const TangentProblem& problem, const Points& x) const;

  /// The inverse Hessian times a covector at x, as DirichletEnergy has gradients: tangent vectors at x. As
  /// far as the factor knows it.
  Points precondition(const Points& gradient) const override;

  /// The inverse of the Hessian itself, times several covectors, up to some digits, by conjugate gradients
  /// that the factor preconditions. Three of them take little longer than one.
  std::vector<Points> solve(const std::vector<Points>& gradients) const;

  /// Is it the second derivative that was factorised?
  bool is_exact() const { return factored_->is_exact; }

 private:
  using Frame = Eigen::Matrix<double, 3, 2>;

  // What does not depend on the frames.
  struct Factored {
    Unknowns unknowns;
    LeadingFactor factor = LeadingFactor(std::vector<int>());
    bool is_exact = true, is_stiff = false;
  };

  TangentSystem(Space space, const Points& x);

  std::shared_ptr<const SparseMatrix> assemble_form(const TangentProblem& problem, const Points& x,
                                                    const Factored& factored) const;

  /// The coordinates of up to three covectors in the frames (unknowns x 3), and what tangent vectors have
  /// these coordinates.
  Points packed(const std::vector<Points>& gradients, std::size_t first) const;
  Points unpacked(const Points& y, Eigen::Index column) const;
  template <int count>
  SingleColumns<count> solved(const SingleColumns<count>& b) const;
  Points conjugate_gradients(const Points& b) const;
  SingleVector refined(const SingleVector& b, const SingleVector& y) const;

  Space space_;
  Points x_;
  std::vector<Frame> frames_;
  std::shared_ptr<const Factored> factored_;

  /// The lower triangle of the form at x, or, if the frames alone were moved, where it was factorised.
  std::shared_ptr<const SparseMatrix> form_;
};

}  // namespace orbitutte
