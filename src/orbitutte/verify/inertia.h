// SPDX-License-Identifier: MIT
// Counts the eigenvalues of a sparse symmetric matrix below a number, by LDL' and Sylvester's law of inertia.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/types.h"

namespace orbitutte {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

enum class InertiaMethod {
  /// LDL' with pivots of order 1 and 2 (optional package).
  mumps,
  /// LDL' without pivoting, which may break down.
  eigen
};

/// Its names.
template <>
struct NameTable<InertiaMethod> {
  static constexpr NamedValue<InertiaMethod> rows[] = {{InertiaMethod::mumps, "mumps"},
                                                       {InertiaMethod::eigen, "eigen"}};
};

/// The methods in this binary; the first is the default.
std::vector<InertiaMethod> available_inertia_methods();

/// The inertia could not be found because the factorisation broke down or memory ran out. what() names a
/// package that would help, if there is one.
class InertiaNotFound : public Error {
 public:
  using Error::Error;
};

/// A symmetric matrix A, analysed once for all shifts.
class InertiaCounter {
 public:
  virtual ~InertiaCounter() = default;

  /// The number of eigenvalues of A x = lambda D x below `shift`. By Sylvester's law it is the number of
  /// negative eigenvalues of the block diagonal factor of A - shift D. Throws InertiaNotFound.
  virtual long eigenvalues_below(double shift) = 0;
};

/// `lower` (n x n) is the lower triangle of A with its diagonal stored in full; `scale` (n) is the diagonal
/// of D, positive. Throws ArgumentError if the method is not in this binary, and InertiaNotFound.
std::unique_ptr<InertiaCounter> inertia_counter(const SymmetricMatrix& lower, const Eigen::VectorXd& scale,
                                                InertiaMethod method);

}  // namespace orbitutte
