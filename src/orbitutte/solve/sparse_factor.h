// SPDX-License-Identifier: MIT
// Sparse Cholesky factorisation behind one small interface: CHOLMOD (where it was built in) or Eigen.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

using SparseMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, long>;

enum class Backend { cholmod, eigen };

/// "cholmod" or "eigen".
std::string name(Backend backend);

/// The backends in this binary; the first is the default (CMake option ORBITUTTE_SOLVER).
std::vector<Backend> available_backends();

/// The BLAS behind the backend: OpenBLAS's own description where it can be asked, "none" for Eigen's.
std::string blas_description(Backend backend);

/// A matrix that is not positive definite; `column` is the first that shows it.
class NotPositiveDefinite : public Error {
 public:
  explicit NotPositiveDefinite(long column_found)
      : Error("the matrix is not positive definite"), column(column_found) {}
  long column;
};

class SparseFactor {
 public:
  virtual ~SparseFactor() = default;

  /// X with A X = B, for all columns of B (n x k).
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const = 0;

  /// L^-1 B and L^-T B, for all columns of B (n x k). Rows are in the factor's own order, which differs from
  /// A's among the leading rows only and is the same in both: the first result may be changed in its trailing
  /// rows and handed to the second. What goes into solve_lower and comes out of solve_upper is in A's order.
  virtual Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const = 0;
  virtual Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& B) const = 0;

  /// The trailing rows and columns of L (t x t, lower triangle): L_TT L_TT' is the Schur complement of A onto
  /// them.
  virtual Eigen::MatrixXd trailing_block() const = 0;
};

/// A = L L' of a symmetric positive definite matrix whose lower triangle is given, its rows and columns
/// already in an order that keeps L sparse (`fill_reducing_order`). The last `trailing` rows and columns stay
/// last. Throws NotPositiveDefinite; ArgumentError where the backend is not in this binary.
std::unique_ptr<SparseFactor> factorize(const SparseMatrix& lower, Backend backend, long trailing = 0);

/// An elimination order of the vertices of a graph by nested dissection (METIS): order[k] is eliminated k-th.
/// start and neighbor list each vertex' neighbours, without loops.
std::vector<int> fill_reducing_order(const std::vector<int>& start, const std::vector<int>& neighbor);

}  // namespace orbitutte
