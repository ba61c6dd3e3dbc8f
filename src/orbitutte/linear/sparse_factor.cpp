// SPDX-License-Identifier: MIT
#include "orbitutte/linear/sparse_factor.h"

#include <dlfcn.h>

#include <Eigen/SparseCholesky>

#include "orbitutte/linear/cholmod_factor.h"
#include "orbitutte/linear/dense_factor.h"

namespace orbitutte {
namespace {

class EigenFactor : public SparseFactor {
 public:
  EigenFactor(const SparseMatrix& lower, long trailing) : factor_(lower), trailing_(trailing) {
    if (factor_.info() != Eigen::Success) throw NotPositiveDefinite(-1);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override { return factor_.solve(B); }

  void forward(Points& y) const override {
    const SparseMatrix& L = factor_.matrixL().nestedExpression();
    for (long column = 0; column < y.rows() - trailing_; ++column) {
      SparseMatrix::InnerIterator entry(L, column);
      const Eigen::RowVector3d here = y.row(column) /= entry.value();
      for (++entry; entry; ++entry) y.row(entry.row()) -= entry.value() * here;
    }
  }

  void backward(Points& y) const override {
    const SparseMatrix& L = factor_.matrixL().nestedExpression();
    for (long column = y.rows() - trailing_; column-- > 0;) {
      SparseMatrix::InnerIterator entry(L, column);
      const double diagonal = entry.value();
      Eigen::RowVector3d here = y.row(column);
      for (++entry; entry; ++entry) here -= entry.value() * y.row(entry.row());
      y.row(column) = here / diagonal;
    }
  }

  Eigen::MatrixXd schur_complement() const override {
    const SparseMatrix& L = factor_.matrixL().nestedExpression();
    Eigen::MatrixXd S = L.bottomRightCorner(trailing_, trailing_);
    multiply_by_transpose(S);
    return S;
  }

 private:
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<SparseMatrix::StorageIndex>>
      factor_;
  long trailing_;
};

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

std::unique_ptr<SparseFactor> factorize(const SparseMatrix& lower, Backend backend, long trailing) {
  if (backend == Backend::eigen) return std::make_unique<EigenFactor>(lower, trailing);
#ifdef ORBITUTTE_HAS_CHOLMOD
  return cholmod_factorize(lower, trailing);
#else
  throw ArgumentError("this binary was built without CHOLMOD; its linear solver is Eigen's");
#endif
}

}  // namespace orbitutte
