// SPDX-License-Identifier: MIT
// The energy (2) as a function of where the cones lie: what the edges across the cut and at cones feel.
#pragma once

#include <vector>

#include "orbitutte/orbifold/moduli.h"
#include "orbitutte/solve/edge_words.h"

namespace orbitutte {

/// Of E(x, p) = sum of w_ij d(x_i, g_ij(p) x_j)^2, in which the positions of cones and corners are p_1 .. p_k
/// and the gluing of each edge is a word in the rotations and reflections that they make, the part that
/// depends on p.
class ModuliEnergy {
 public:
  /// w: of the edges, mirror images included. cones: the input vertices of the marks, in the order of the
  /// moduli. moduli and edges must outlive this.
  ModuliEnergy(const Moduli& moduli, const EdgeWords& edges, Eigen::VectorXd w, std::vector<int> cones);

  /// All edges with their gluing.
  GluedEdges glued(const Points& cones) const;

  /// x with the cones at their positions; x: n x 3.
  Points with_cones(Points x, const Points& cones) const;

  /// The energy of the edges that depend on p.
  double energy(const Points& x, const Points& cones) const;

  /// The gradient of that energy by x (n x 3), covectors as DirichletEnergy has them; zero at the cones.
  Points gradient(const Points& x, const Points& cones) const;

  /// The derivative of E by steps of the cones (2k numbers: Moduli), all other x being held.
  Eigen::VectorXd cone_gradient(const Points& x, const Points& cones) const;

  /// The same by the parameters of cones that move.
  Eigen::VectorXd cone_gradient(const Points& x, const VaryingMarks& marks) const;

  /// Second derivatives by q parameters of cones that move.
  struct Curvature {
    /// q x q.
    Eigen::MatrixXd energy;

    /// q times n x 3: how the gradient by x changes.
    std::vector<Points> gradient;
  };

  /// marks: known to second order.
  Curvature curvature(const Points& x, const VaryingMarks& marks) const;

  /// The same of steps along geodesics in q directions: 2k x q.
  Curvature curvature(const Points& x, const Points& cones, const Eigen::MatrixXd& directions) const {
    return curvature(x, moduli_.varying(cones, directions, Order::second));
  }

 private:
  std::vector<Isometry> transforms(const Points& cones) const;
  std::vector<VaryingIsometry> varying_transforms(const VaryingMarks& marks, Eigen::Index parameters,
                                                  Order order) const;

  /// The beginnings of all words, each by one letter longer than another before it; the empty one first.
  struct Beginning {
    int shorter = 0, letter = 0;
  };
  void list_beginnings();

  /// Of the beginnings, rounded once.
  std::vector<Isometry> products(const Points& cones) const;

  /// How the far end of an edge moves, as it is seen from the near one.
  VaryingMotion motion_along(const GluedEdge& edge, const VaryingIsometry& transform,
                             const VaryingMarks& marks) const;

  /// Calls visit(edge, w, x_i, g x_j) for every edge that depends on p.
  template <typename Visit>
  void for_each(const Points& x, const std::vector<Isometry>& transforms, const Visit& visit) const;

  const Moduli& moduli_;
  const EdgeWords& edges_;
  Eigen::VectorXd w_;
  std::vector<int> cones_;

  /// The beginnings, and which of them each word is.
  std::vector<Beginning> beginnings_;
  std::vector<int> beginning_of_word_;

  /// n: the number of the cone that a vertex is, or -1.
  std::vector<int> cone_at_;

  /// The edges that depend on p.
  std::vector<int> dependent_;
};

}  // namespace orbitutte
