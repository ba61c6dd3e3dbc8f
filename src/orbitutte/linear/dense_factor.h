// SPDX-License-Identifier: MIT
// Cholesky factorisation of dense fronts, by BLAS and LAPACK tile by tile. Private to linear/ and solve/.
#pragma once

#include <Eigen/Core>

namespace orbitutte {

/// A matrix that is zero in its lower triangle, and undefined above.
Eigen::MatrixXd zero_lower_triangle(Eigen::Index n);

/// With the symmetric A = [A_OO, A_BO'; A_BO, A_BB], O its first `own` rows, replaces A_OO by L_OO, A_OO =
/// L_OO L_OO', A_BO by L_BO = A_BO L_OO^-T, and A_BB by the Schur complement A_BB - L_BO L_BO'. Reads and
/// writes lower triangles; what lies above them means nothing afterwards. The same bits whatever the number
/// of threads. Throws NotPositiveDefinite.
void partial_cholesky(Eigen::MatrixXd& A, Eigen::Index own);

/// The lower triangle of L L' for a lower triangular L, in place.
void multiply_by_transpose(Eigen::MatrixXd& L);

/// Columns of a lower triangular L, stored densely: the rows of the columns themselves first, then those of
/// their border.
struct DenseColumns {
  const double* values;  ///< rows x columns, column by column
  long rows, columns, stride;

  long border() const { return rows - columns; }
};

/// With the columns' own block L_OO and their border's L_BO: y <- L_OO^-1 y, pull = L_BO y. y: columns x 3,
/// row by row; pull: border x 3, column by column.
void forward(const DenseColumns& L, double* y, double* pull);

/// y <- L_OO^-T (y - L_BO' x). y: columns x 3, row by row; x: border x 3, column by column.
void backward(const DenseColumns& L, double* y, const double* x);

/// BLAS calls run on the thread that makes them: two BLAS threads gain little on small fronts and lose much
/// on a busy machine.
void use_one_blas_thread();

}  // namespace orbitutte
