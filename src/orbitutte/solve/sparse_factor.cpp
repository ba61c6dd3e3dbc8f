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
  explicit EigenFactor(const SparseMatrix& lower) : factor_(lower) {
    if (factor_.info() != Eigen::Success) throw NotPositiveDefinite(-1);
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override { return factor_.solve(B); }
  double nonzeros() const override {
    return static_cast<double>(factor_.matrixL().nestedExpression().nonZeros());
  }

 private:
  Eigen::SimplicialLLT<SparseMatrix, Eigen::Lower, Eigen::NaturalOrdering<SparseMatrix::StorageIndex>>
      factor_;
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

std::unique_ptr<SparseFactor> factorize(const SparseMatrix& lower, Backend backend) {
  if (backend == Backend::eigen) return std::make_unique<EigenFactor>(lower);
#ifdef ORBITUTTE_HAS_CHOLMOD
  return cholmod_factorize(lower);
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
