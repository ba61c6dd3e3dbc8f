// SPDX-License-Identifier: MIT
#include "orbitutte/linear/sparse_factor.h"

#include <dlfcn.h>

#include <Eigen/SparseCholesky>
#include <numeric>
#include <utility>
#include <vector>

#include "orbitutte/linear/cholmod_factor.h"
#include "orbitutte/linear/dense_factor.h"

namespace orbitutte {
namespace {

using EigenCholesky =
    Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<SparseMatrix::StorageIndex>>;

class EigenFactor : public SparseFactor {
 public:
  explicit EigenFactor(const SparseMatrix& lower) : factor_(lower) {
    if (factor_.info() != Eigen::Success) throw NotPositiveDefinite(-1);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override { return factor_.solve(B); }

 private:
  EigenCholesky factor_;
};

template <typename Real>
Elimination<Real> eigen_eliminate(const SparseMatrix& lower, long trailing) {
  const EigenCholesky cholesky(lower);
  if (cholesky.info() != Eigen::Success) throw NotPositiveDefinite(-1);
  const SparseMatrix& L = cholesky.matrixL().nestedExpression();
  std::vector<int> order(L.rows());
  std::iota(order.begin(), order.end(), 0);
  Eigen::MatrixXd update = L.bottomRightCorner(trailing, trailing);
  multiply_by_transpose(update);
  update -= Eigen::MatrixXd(lower.bottomRightCorner(trailing, trailing));
  Elimination<Real> result = {LeadingFactor(std::move(order)), update.cast<Real>()};
  for (long column = 0; column < L.cols() - trailing; ++column) {
    const long begin = L.outerIndexPtr()[column], end = L.outerIndexPtr()[column + 1];
    result.factor.append(
        LeadingFactor::Supernode<double>{L.innerIndexPtr() + begin, L.valuePtr() + begin, end - begin, 1});
  }
  return result;
}

}  // namespace

bool equal(const SparseMatrix& A, const SparseMatrix& B) {
  const long columns = A.cols(), nonzeros = A.nonZeros();
  return columns == B.cols() && nonzeros == B.nonZeros() &&
         std::equal(A.outerIndexPtr(), A.outerIndexPtr() + columns, B.outerIndexPtr()) &&
         std::equal(A.innerIndexPtr(), A.innerIndexPtr() + nonzeros, B.innerIndexPtr()) &&
         std::equal(A.valuePtr(), A.valuePtr() + nonzeros, B.valuePtr());
}

std::vector<Backend> available_backends() {
#ifdef ORBITUTTE_HAS_CHOLMOD
  return {Backend::cholmod, Backend::eigen};
#else
  return {Backend::eigen};
#endif
}

std::string blas_description() {
  using Describe = char* (*)();
  const auto describe = reinterpret_cast<Describe>(dlsym(RTLD_DEFAULT, "openblas_get_config"));
  return describe ? describe() : "unknown";
}

#ifndef ORBITUTTE_HAS_CHOLMOD
namespace {

// What stands for CHOLMOD where it was not built in.
[[noreturn]] void refuse_cholmod() {
  throw ArgumentError("this binary was built without CHOLMOD; its linear solver is Eigen's");
}
std::unique_ptr<SparseFactor> cholmod_factorize(const SparseMatrix&) { refuse_cholmod(); }
template <typename Real>
Elimination<Real> cholmod_eliminate(const SparseMatrix&, long) {
  refuse_cholmod();
}

}  // namespace
#endif

std::unique_ptr<SparseFactor> factorize(const SparseMatrix& lower, Backend backend) {
  if (backend == Backend::eigen) return std::make_unique<EigenFactor>(lower);
  return cholmod_factorize(lower);
}

template <typename Real>
Elimination<Real> eliminate(const SparseMatrix& lower, Backend backend, long trailing) {
  return backend == Backend::eigen ? eigen_eliminate<Real>(lower, trailing)
                                   : cholmod_eliminate<Real>(lower, trailing);
}

template Elimination<float> eliminate(const SparseMatrix& lower, Backend backend, long trailing);
template Elimination<double> eliminate(const SparseMatrix& lower, Backend backend, long trailing);

}  // namespace orbitutte
