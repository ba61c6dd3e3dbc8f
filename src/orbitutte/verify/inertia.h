// SPDX-License-Identifier: MIT
// How many eigenvalues of a sparse symmetric matrix lie below a number, by LDL' and Sylvester's law of
// inertia.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

using SymmetricMatrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

enum class InertiaMethod {
  mumps,  ///< LDL' with pivots of order 1 and 2 (optional package)
  eigen   ///< LDL' without pivoting; it may break down
};

/// "mumps" or "eigen".
std::string name(InertiaMethod method);

/// The methods in this binary; the first is the default.
std::vector<InertiaMethod> available_inertia_methods();

/// The inertia could not be found: the factorisation broke down, or memory ran out; what() names the package
/// that would help, where one would.
class InertiaNotFound : public Error {
 public:
  using Error::Error;
};

/// A symmetric matrix A, analysed once for all shifts.
class InertiaCounter {
 public:
  virtual ~InertiaCounter() = default;

  /// The number of eigenvalues of A x = lambda D x that are below `shift`: by Sylvester's law that of the
  /// negative ones in the D of A - shift D = L D L'. Throws InertiaNotFound.
  virtual long eigenvalues_below(double shift) = 0;
};

/// `lower` (n x n): the lower triangle of A, its diagonal stored in full; `scale` (n): the diagonal of D,
/// positive. Throws ArgumentError where the method is not in this binary, InertiaNotFound.
std::unique_ptr<InertiaCounter> inertia_counter(const SymmetricMatrix& lower, const Eigen::VectorXd& scale,
                                                InertiaMethod method);

}  // namespace orbitutte
