// SPDX-License-Identifier: MIT
// Values as weighted sums of other values: sparse matrices by rows, which can be kept and used without any
// geometry.
#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

namespace orbitutte {

/// A sparse matrix by rows (CSR): row r has the weights weight[start[r]] .. weight[start[r + 1] - 1] in the
/// columns index[...], ascending. A row that is empty has no value: apply makes it NaN.
struct SparseTable {
  int columns = 0;

  /// One entry more than there are rows.
  std::vector<int> start = {0};
  std::vector<int> index;
  std::vector<double> weight;

  int rows() const { return static_cast<int>(start.size()) - 1; }
};

/// Up to four weighted columns.
struct Stencil {
  std::array<int, 4> index = {0, 0, 0, 0};
  std::array<double, 4> weight = {0, 0, 0, 0};
  int count = 0;

  void add(int column, double share) {
    index[count] = column;
    weight[count++] = share;
  }
};

/// Each row is the mean of so many consecutive stencils; weights of one column are added, and zeros left out.
/// Throws ArgumentError if there are more than 2^31 - 1 weights.
SparseTable table_of_stencils(int columns, const std::vector<Stencil>& stencils, int stencils_per_row = 1);

/// Each row has the column of the largest weight alone, the first of these, with the weight 1.
SparseTable largest_weights(const SparseTable& table);

/// The transposed matrix.
SparseTable transposed(const SparseTable& table);

/// The sum of two matrices of one shape, each with its rows multiplied by its factors.
struct ScaledTable {
  const SparseTable& table;
  const Eigen::VectorXd& factors;
};
SparseTable sum_of(const ScaledTable& a, const ScaledTable& b);

/// The sum of each row's weights.
Eigen::VectorXd row_sums(const SparseTable& table);

/// Multiplies the weights of each row by its factor.
void scale_rows(SparseTable& table, const Eigen::VectorXd& factors);

/// Divides the weights of each row by their sum. Rows whose sum is zero become empty.
void normalize_rows(SparseTable& table);

/// table * values (columns x maps): rows x maps, NaN where a row is empty. Throws ArgumentError if there are
/// not as many rows of values as the table has columns.
Eigen::MatrixXd apply(const SparseTable& table, const Eigen::MatrixXd& values);

/// The same for labels, which cannot be added: of the labels of each row that with the largest sum of
/// weights, the smallest of these.
Eigen::MatrixXd apply_to_labels(const SparseTable& table, const Eigen::MatrixXd& labels);

/// The areas of what the rows and the columns of a table stand for.
struct TableAreas {
  const Eigen::VectorXd &rows, &columns;
};

/// Labels that keep their areas: each row gets one of the labels in it, so that the area of the rows with a
/// label is that of the columns with it, as nearly as whole rows can make it, and as much area as possible
/// has its own label. This is a transport problem; its dual has a price for each label, and a row takes the
/// label with the largest sum of weights minus its price (F. Aurenhammer, F. Hoffmann, B. Aronov,
/// "Minkowski-type theorems and least-squares clustering", 1998; without prices it is apply_to_labels). The
/// prices are sought until all areas are kept within 0.1 %, for 300 steps at most. Throws ArgumentError as
/// `apply` does, and if there is not an area for each row and column.
Eigen::MatrixXd labels_keeping_areas(const SparseTable& table, const Eigen::MatrixXd& labels,
                                     const TableAreas& areas);

}  // namespace orbitutte
