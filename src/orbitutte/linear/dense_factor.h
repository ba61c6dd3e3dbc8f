// SPDX-License-Identifier: MIT
// Cholesky factorisation of dense fronts, by BLAS and LAPACK tile by tile. Private to linear/ and solve/.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace orbitutte {

/// n x count, right-hand sides or solutions, one or three. Solves run in single precision: they shape steps
/// and starts, whose errors the optimiser's gradient, which is in double precision, tells it to remove.
template <int count>
using SingleColumns =
    Eigen::Matrix<float, Eigen::Dynamic, count, count == 1 ? Eigen::ColMajor : Eigen::RowMajor>;
using SinglePoints = SingleColumns<3>;
using SingleVector = SingleColumns<1>;

/// In single or double precision.
template <typename Real>
using DenseMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// A matrix that is zero in its lower triangle and undefined above.
template <typename Real>
DenseMatrix<Real> zero_lower_triangle(Eigen::Index n);

/// The lower triangle of a symmetric A = [A_OO, A_BO'; A_BO, A_BB], stored elsewhere column by column: the
/// columns of its `own` rows O, (own + border) x own, and A_BB, border x border.
template <typename Real>
struct Front {
  long own, border;
  Real* columns;
  Real* rest;

  long size() const { return own + border; }
  /// Of the lower triangle.
  Real& operator()(long row, long column) const {
    return column < own ? columns[row + column * size()] : rest[row - own + (column - own) * border];
  }
};

/// Adds the lower triangle of a symmetric matrix to that of a front, which has its row k as row at[k],
/// ascending.
template <typename Real>
void add(const DenseMatrix<Real>& update, const std::vector<long>& at, const Front<Real>& front);

/// Factorises the own rows of a front in place: L_OO with A_OO = L_OO L_OO' replaces A_OO, L_BO = A_BO
/// L_OO^-T replaces A_BO, and the Schur complement A_BB - L_BO L_BO' replaces A_BB. Upper triangles are
/// undefined afterwards. The result has the same bits for any number of threads. Throws NotPositiveDefinite.
template <typename Real>
void partial_cholesky(const Front<Real>& front);

/// The same for all rows of a matrix, given by its lower triangle.
template <typename Real>
void cholesky(DenseMatrix<Real>& A) {
  partial_cholesky(Front<Real>{A.rows(), 0, A.data(), nullptr});
}

/// The lower triangle of L L' for a lower triangular L, in place.
void multiply_by_transpose(Eigen::MatrixXd& L);

/// Columns of a lower triangular L, stored densely: first the rows of the columns themselves, then the rows
/// of their border.
struct DenseColumns {
  /// rows x columns, column by column.
  const float* values;
  long rows, columns, stride;

  long border() const { return rows - columns; }
};

/// y_O <- L_OO^-1 y_O, then y_B <- y_B - L_BO y_O, where L_OO is the columns' own block and L_BO their
/// border's. y: rows x vectors, one or three of them, column by column.
template <int vectors>
void forward(const DenseColumns& L, float* y);

/// y_O <- L_OO^-T (y_O - L_BO' y_B). y: as for `forward`.
template <int vectors>
void backward(const DenseColumns& L, float* y);

}  // namespace orbitutte
