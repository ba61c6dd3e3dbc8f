// SPDX-License-Identifier: MIT
#include "orbitutte/solve/sparse_factor.h"

#include <dlfcn.h>
#include <metis.h>

#include <Eigen/SparseCholesky>
#include <new>
#include <numeric>

#include "orbitutte/solve/cholmod_factor.h"

namespace orbitutte {
namespace {

class EigenFactor : public SparseFactor {
 public:
  EigenFactor(const SparseMatrix& lower, long trailing) : factor_(lower), trailing_(trailing) {
    if (factor_.info() != Eigen::Success) throw NotPositiveDefinite(-1);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override { return factor_.solve(B); }
  Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const override { return factor_.matrixL().solve(B); }
  Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& B) const override { return factor_.matrixU().solve(B); }

  Eigen::MatrixXd trailing_block() const override {
    const SparseMatrix& L = factor_.matrixL().nestedExpression();
    return L.bottomRightCorner(trailing_, trailing_);
  }

 private:
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<SparseMatrix::StorageIndex>>
      factor_;
  long trailing_;
};

}  // namespace

std::string name(Backend backend) { return backend == Backend::cholmod ? "cholmod" : "eigen"; }

std::vector<Backend> available_backends() {
#ifdef ORBITUTTE_HAS_CHOLMOD
  return {Backend::cholmod, Backend::eigen};
#else
  return {Backend::eigen};
#endif
}

std::string blas_description(Backend backend) {
  if (backend == Backend::eigen) return "none";
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

std::vector<int> fill_reducing_order(const std::vector<int>& start, const std::vector<int>& neighbor) {
  idx_t count = static_cast<idx_t>(start.size()) - 1;
  std::vector<idx_t> xadj(start.begin(), start.end()), adjncy(neighbor.begin(), neighbor.end());
  std::vector<idx_t> order(count), position(count);
  if (neighbor.empty()) {
    std::iota(order.begin(), order.end(), 0);
  } else {
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 0;
    const int status =
        METIS_NodeND(&count, xadj.data(), adjncy.data(), nullptr, options, order.data(), position.data());
    if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
    if (status != METIS_OK) throw Error("METIS could not order the mesh");
  }
  return {order.begin(), order.end()};
}

}  // namespace orbitutte
