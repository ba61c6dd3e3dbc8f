// SPDX-License-Identifier: MIT
// The numeric phase of a sparse Cholesky factorisation, front by front (I. Duff, J. Reid, "The multifrontal
// solution of indefinite sparse symmetric linear equations", ACM TOMS 9 (1983)). Private to linear/.
#pragma once

#include <span>
#include <vector>

#include "orbitutte/linear/sparse_factor.h"

namespace orbitutte {

/// Where the factor of a permuted matrix has entries.
struct SupernodePattern {
  /// Row k of the factor is row order[k] of the matrix.
  std::vector<int> order;
  /// Supernode s has the columns first[s] .. first[s + 1] - 1.
  std::span<const long> first;
  /// Its rows are row[start[s]] .. row[start[s + 1] - 1], ascending, those of its columns first.
  std::span<const long> start, row;

  int count() const { return static_cast<int>(first.size()) - 1; }
  std::span<const long> rows(int s) const { return row.subspan(start[s], start[s + 1] - start[s]); }
};

/// Eliminates all but the last `trailing` rows and columns of a matrix, given by its lower triangle, which
/// stay last in the pattern. Throws NotPositiveDefinite.
template <typename Real>
Elimination<Real> eliminate_along(const SupernodePattern& pattern, const SparseMatrix& lower, long trailing);

}  // namespace orbitutte
