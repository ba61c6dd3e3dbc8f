// SPDX-License-Identifier: MIT
// A sparse Cholesky factorisation along the upper part of a dissection tree: every subtree below it is
// factorised on its own, at the same time as the others, and dense fronts join them (J. Przemieniecki's
// substructures; I. Duff, J. Reid, "The multifrontal solution of indefinite sparse symmetric linear
// equations", ACM TOMS 9 (1983)). Private to linear/ and solve/.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/linear/sparse_factor.h"

namespace orbitutte {

/// Unknowns begin .. end - 1, eliminated together. Blocks without children are sparse, those with children,
/// the separators, dense.
struct EliminationBlock {
  int parent = -1;  ///< a later block, or -1 at the last
  long begin = 0, end = 0;
};

/// K = [K_II, K_BI'; K_BI, K_BB] with the unknowns I in the blocks and the rest B, K_II = L_II L_II', L_BI =
/// K_BI L_II^-T.
class Substructure {
 public:
  /// The lower triangle of K, positive definite and with nonpositive entries off the diagonal; its unknowns
  /// in the order of the blocks, B last. Entries between two unknowns lie within a block, between a block and
  /// one on its way to the last, or in B. Sparse blocks of an earlier substructure with as many blocks are
  /// taken from it where their equations are the same. Throws NotPositiveDefinite with the unknown.
  Substructure(const SparseMatrix& lower, const std::vector<EliminationBlock>& blocks, Backend backend,
               const Substructure* earlier = nullptr);
  ~Substructure();
  Substructure(Substructure&&) noexcept;

  /// y_I <- L_II^-1 y_I (in an order of its own), y_B <- y_B - L_BI y_I.
  void forward(Points& y) const;

  /// y_I <- L_II^-T (y_I - L_BI' y_B), back in K's order.
  void backward(Points& y) const;

  /// K_BB - L_BI L_BI', whole.
  const Eigen::MatrixXd& schur_complement() const { return schur_complement_; }

  /// The number of unknowns in B.
  long border() const { return border_; }

  /// Frees what serves only later substructures, and the Schur complement.
  void release_what_solving_does_not_need();

 private:
  struct Piece;
  std::vector<Piece> pieces_;               // one for each block
  std::vector<std::vector<int>> by_depth_;  // pieces, those of the last depth first
  long border_begin_ = 0, border_ = 0;
  Eigen::MatrixXd schur_complement_;
};

}  // namespace orbitutte
