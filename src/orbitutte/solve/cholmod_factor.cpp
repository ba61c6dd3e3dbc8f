// SPDX-License-Identifier: MIT
// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, "Algorithm 887: CHOLMOD", ACM TOMS 35 (2008).
#include "orbitutte/solve/cholmod_factor.h"

#ifdef ORBITUTTE_HAS_CHOLMOD

#include <cholmod.h>
#include <dlfcn.h>
#include <omp.h>

#include <cstring>
#include <new>

namespace orbitutte {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(SparseMatrix::StorageIndex));

// Two BLAS threads gain nothing on small fronts and lose much on a busy machine.
void use_one_blas_thread() {
  using SetThreads = void (*)(int);
  if (const auto set = reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))) set(1);
}

// CHOLMOD opens a parallel region of its own for every supernode, which costs more than it gains; while this
// lives, OpenMP regions run on the calling thread.
class SerialRegions {
 public:
  SerialRegions() : before_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~SerialRegions() { omp_set_max_active_levels(before_); }
  SerialRegions(const SerialRegions&) = delete;
  SerialRegions& operator=(const SerialRegions&) = delete;

 private:
  int before_;
};

cholmod_dense dense_view(const Eigen::MatrixXd& matrix) {
  cholmod_dense view = {};
  view.nrow = view.d = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = view.nrow * view.ncol;
  view.x = const_cast<double*>(matrix.data());  // CHOLMOD's inputs are not const, but are not written to
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  return view;
}

cholmod_sparse sparse_view(const SparseMatrix& lower) {
  cholmod_sparse view = {};
  view.nrow = view.ncol = static_cast<std::size_t>(lower.rows());
  view.nzmax = static_cast<std::size_t>(lower.nonZeros());
  view.p = const_cast<long*>(lower.outerIndexPtr());
  view.i = const_cast<long*>(lower.innerIndexPtr());
  view.x = const_cast<double*>(lower.valuePtr());
  view.stype = -1;
  view.itype = CHOLMOD_LONG;
  view.xtype = CHOLMOD_REAL;
  view.dtype = CHOLMOD_DOUBLE;
  view.sorted = view.packed = 1;
  return view;
}

class CholmodFactor : public SparseFactor {
 public:
  explicit CholmodFactor(const SparseMatrix& lower) {
    use_one_blas_thread();
    const SerialRegions serial;
    cholmod_l_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_NATURAL;
    common_.postorder = 1;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    cholmod_sparse A = sparse_view(lower);
    factor_ = cholmod_l_analyze(&A, &common_);
    if (factor_) cholmod_l_factorize(&A, factor_, &common_);
    if (common_.status != CHOLMOD_OK) fail();
  }

  ~CholmodFactor() override { release(); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override {
    cholmod_dense b = dense_view(B);
    cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, factor_, &b, &common_);
    if (!x) throw std::bad_alloc();
    Eigen::MatrixXd X = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x->x), B.rows(), B.cols());
    cholmod_l_free_dense(&x, &common_);
    return X;
  }

  double nonzeros() const override { return common_.lnz; }

 private:
  void release() {
    cholmod_l_free_factor(&factor_, &common_);
    cholmod_l_finish(&common_);
  }

  [[noreturn]] void fail() {
    const int status = common_.status;
    const long column = factor_ && status == CHOLMOD_NOT_POSDEF
                            ? static_cast<const long*>(factor_->Perm)[factor_->minor]
                            : -1;
    release();
    if (status == CHOLMOD_NOT_POSDEF) throw NotPositiveDefinite(column);
    throw std::bad_alloc();
  }

  mutable cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
};

}  // namespace

std::unique_ptr<SparseFactor> cholmod_factorize(const SparseMatrix& lower) {
  return std::make_unique<CholmodFactor>(lower);
}

}  // namespace orbitutte

#endif
