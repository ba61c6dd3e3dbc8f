// SPDX-License-Identifier: MIT
// The columns of a sparse Cholesky factor that belong to the leading rows, in single precision. Solving reads
// the whole factor twice, so it takes half the time at half the size. Private to linear/ and solve/.
#pragma once

#include <vector>

#include "orbitutte/linear/dense_factor.h"

namespace orbitutte {

/// The factor of A = [A_LL, A_TL'; A_TL, A_TT], where T are the trailing rows: A_LL = L_LL L_LL' and
/// L_TL = A_TL L_LL^-T, made of supernodes, which are consecutive columns with the same rows below them.
class LeadingFactor {
 public:
  /// Without columns yet. order: row k of the factor is row order[k] of A; the trailing rows are the last.
  explicit LeadingFactor(std::vector<int> order) : order_(std::move(order)) {}

  /// The next supernode: rows x columns, column by column, and the row of the factor in which each stored row
  /// lies, those of the columns themselves first.
  template <typename Real>
  struct Supernode {
    const long* row;
    const Real* values;
    long rows, columns;
  };

  /// Makes room for so many rows and values of supernodes.
  void reserve(std::size_t rows, std::size_t values);

  template <typename Real>
  void append(const Supernode<Real>& supernode);

  /// y_L <- L_LL^-1 y_L, y_T <- y_T - L_TL y_L (n x 1 or n x 3). Leaves the leading rows in the factor's
  /// order, which `backward` expects.
  template <int count>
  void forward(SingleColumns<count>& y) const;

  /// y_L <- L_LL^-T (y_L - L_TL' y_T) (n x 1 or n x 3). Takes the leading rows in the factor's order and
  /// returns them in A's.
  template <int count>
  void backward(SingleColumns<count>& y) const;

 private:
  struct Stored {
    long first_column, first_row, first_value;  // in A, row_ and value_
    long rows, columns;
  };

  DenseColumns columns_of(const Stored& s) const {
    return {value_.data() + s.first_value, s.rows, s.columns, s.rows};
  }

  /// The rows of a supernode (rows x count, column by column), and its first `rows` rows back again.
  template <int count>
  void gather(const Stored& s, const SingleColumns<count>& y, float* local) const;
  template <int count>
  void scatter(const Stored& s, long rows, const float* local, SingleColumns<count>& y) const;

  std::vector<int> order_;
  std::vector<Stored> supernode_;
  std::vector<int> row_;
  std::vector<float> value_;
  long most_rows_ = 0;
};

}  // namespace orbitutte
