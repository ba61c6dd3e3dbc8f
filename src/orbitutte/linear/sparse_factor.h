// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation behind one small interface: CHOLMOD (if it was built in) or Eigen.
#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "orbitutte/options.h"
#include "orbitutte/types.h"

namespace orbitutte {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, long>;

/// Do both have the same entries, stored in the same order?
bool equal(const SparseMatrix& A, const SparseMatrix& B);

/// The matrix is not positive definite. `column` is the first column that shows it, or -1 if that is not
/// known.
class NotPositiveDefinite : public Error {
 public:
  explicit NotPositiveDefinite(long column_found)
      : Error("the matrix is not positive definite"), column(column_found) {}
  long column;
};

/// The factor of A = [A_LL, A_TL'; A_TL, A_TT], where T are the trailing rows (none by default): A_LL = L_LL
/// L_LL' and L_TL = A_TL L_LL^-T.
class SparseFactor {
 public:
  virtual ~SparseFactor() = default;

  /// Returns X with A X = B, for all columns of B (n x k).
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const = 0;

  /// y_L <- L_LL^-1 y_L, y_T <- y_T - L_TL y_L (n x 3). Leaves the leading rows in the factor's own order,
  /// which `backward` expects.
  virtual void forward(Points& y) const = 0;

  /// y_L <- L_LL^-T (y_L - L_TL' y_T) (n x 3). Takes the leading rows in the factor's order and returns them
  /// in A's.
  virtual void backward(Points& y) const = 0;

  /// The lower triangle of A_TT - L_TL L_TL'.
  virtual Eigen::MatrixXd schur_complement() const = 0;
};

/// Factorises a symmetric positive definite matrix, given by its lower triangle. Its rows and columns must
/// already be in an order that keeps L sparse (`dissect`). The last `trailing` rows and columns stay last.
/// Throws NotPositiveDefinite, and ArgumentError if the backend is not in this binary.
std::unique_ptr<SparseFactor> factorize(const SparseMatrix& lower, Backend backend, long trailing = 0);

}  // namespace orbitutte
