// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation behind one small interface: CHOLMOD (if it was built in) or Eigen.
#pragma once

#include <Eigen/SparseCore>
#include <memory>

#include "orbitutte/linear/leading_factor.h"
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

/// The factor of a matrix A, in double precision.
class SparseFactor {
 public:
  virtual ~SparseFactor() = default;

  /// Returns X with A X = B, for all columns of B (n x k).
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const = 0;
};

/// Factorises a symmetric positive definite matrix, given by its lower triangle. Its rows and columns must
/// already be in an order that keeps L sparse (`dissect`). Throws NotPositiveDefinite, and ArgumentError if
/// the backend is not in this binary.
std::unique_ptr<SparseFactor> factorize(const SparseMatrix& lower, Backend backend);

/// What is left of A = [A_LL, A_TL'; A_TL, A_TT], where T are the trailing rows, once L is eliminated.
template <typename Real>
struct Elimination {
  LeadingFactor factor;
  /// The lower triangle of -L_TL L_TL', to be added to A_TT.
  DenseMatrix<Real> update;
};

/// Eliminates all but the last `trailing` rows and columns, in single or double precision (Eigen always in
/// double precision); otherwise as `factorize`.
template <typename Real>
Elimination<Real> eliminate(const SparseMatrix& lower, Backend backend, long trailing);

}  // namespace orbitutte
