// SPDX-License-Identifier: MIT
// A sparse Cholesky factorisation along the upper part of a dissection tree. The subtrees below it are
// factorised in parallel, each by itself, and dense fronts join them (J. Przemieniecki's substructures; I.
// Duff, J. Reid, "The multifrontal solution of indefinite sparse symmetric linear equations", ACM TOMS 9
// (1983)). Private to linear/ and solve/.
#pragma once

#include <memory>
#include <tuple>
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

/// The precision in which fronts are factorised and added up; factors are kept in single precision.
enum class Precision { single, full };

class Substructure;

struct SubstructureOptions {
  Backend backend = available_backends().front();
  Precision precision = Precision::single;
  /// Blocks are taken from it if it has as many of them and all that goes into them is the same; null: none.
  const Substructure* earlier = nullptr;
  /// May a later one take blocks of this one? Then it keeps more.
  bool serves_later = false;
};

/// The factor of K = [K_II, K_BI'; K_BI, K_BB], where I are the unknowns in the blocks and B the rest: K_II =
/// L_II L_II' and L_BI = K_BI L_II^-T.
class Substructure {
 public:
  /// Factorises K, given by its lower triangle, positive definite and with nonpositive entries off the
  /// diagonal. Its unknowns are in the order of the blocks, with B last. An entry couples two unknowns of one
  /// block, of a block and one on its way to the last, or of any block or B with B. Throws
  /// NotPositiveDefinite with the unknown.
  Substructure(const SparseMatrix& lower, const std::vector<EliminationBlock>& blocks,
               const SubstructureOptions& options);
  ~Substructure();
  Substructure(Substructure&&) noexcept;

  /// y_I <- L_II^-1 y_I, left in an order of its own; y_B <- y_B - L_BI y_I.
  void forward(SinglePoints& y) const;

  /// y_I <- L_II^-T (y_I - L_BI' y_B), back in K's order.
  void backward(SinglePoints& y) const;

  Precision precision() const { return precision_; }

  /// The lower triangle of K_BB - L_BI L_BI', in the precision of the fronts: float or double.
  template <typename Real>
  const DenseMatrix<Real>& schur_complement() const {
    return std::get<DenseMatrix<Real>>(schur_complement_);
  }

  /// The number of unknowns in B.
  long border() const { return border_; }

  /// Frees the Schur complement, which solves do not need.
  void release_schur_complement() { schur_complement_ = {}; }

 private:
  struct Piece;
  template <typename Real>
  void eliminate(const SparseMatrix& lower, const SubstructureOptions& options);

  /// One for each block.
  std::vector<Piece> pieces_;
  /// Pieces by depth, the deepest first.
  std::vector<std::vector<int>> by_depth_;
  long border_begin_ = 0, border_ = 0;
  Precision precision_;
  /// The one in the other precision is empty.
  std::tuple<Eigen::MatrixXf, Eigen::MatrixXd> schur_complement_;
};

}  // namespace orbitutte
