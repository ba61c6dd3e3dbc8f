// SPDX-License-Identifier: MIT
// A sparse Cholesky factorisation along the upper part of a dissection tree. The subtrees below it are
// factorised in parallel, each by itself, and dense fronts join them (J. Przemieniecki's substructures; I.
// Duff, J. Reid, "The multifrontal solution of indefinite sparse symmetric linear equations", ACM TOMS 9
// (1983)). Private to linear/ and solve/.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/linear/sparse_factor.h"

namespace orbitutte {

/// Unknowns begin .. end - 1, which are eliminated together. Blocks without children are sparse; blocks with
/// children, the separators, are dense.
struct EliminationBlock {
  /// A later block; -1 for the last.
  int parent = -1;
  long begin = 0, end = 0;
};

/// The factor of K = [K_II, K_BI'; K_BI, K_BB], where I are the unknowns in the blocks and B the rest: K_II =
/// L_II L_II' and L_BI = K_BI L_II^-T.
class Substructure {
 public:
  /// Factorises K, given by its lower triangle, positive definite and with nonpositive entries off the
  /// diagonal. Its unknowns are in the order of the blocks, with B last. An entry couples two unknowns of one
  /// block, of a block and one on its way to the last, or of any block or B with B. Sparse blocks are taken
  /// from `earlier` if it has as many blocks and the equations are the same. Throws NotPositiveDefinite with
  /// the unknown.
  Substructure(const SparseMatrix& lower, const std::vector<EliminationBlock>& blocks, Backend backend,
               const Substructure* earlier = nullptr);
  ~Substructure();
  Substructure(Substructure&&) noexcept;

  /// y_I <- L_II^-1 y_I, left in an order of its own; y_B <- y_B - L_BI y_I.
  void forward(SinglePoints& y) const;

  /// y_I <- L_II^-T (y_I - L_BI' y_B), back in K's order.
  void backward(SinglePoints& y) const;

  /// K_BB - L_BI L_BI', both triangles.
  const Eigen::MatrixXd& schur_complement() const { return schur_complement_; }

  /// The number of unknowns in B.
  long border() const { return border_; }

  /// Frees the Schur complement and what serves only later substructures.
  void release_what_solving_does_not_need();

 private:
  struct Piece;
  /// One for each block.
  std::vector<Piece> pieces_;
  /// Pieces by depth, the deepest first.
  std::vector<std::vector<int>> by_depth_;
  long border_begin_ = 0, border_ = 0;
  Eigen::MatrixXd schur_complement_;
};

}  // namespace orbitutte
