// SPDX-License-Identifier: MIT
// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, "Algorithm 887: CHOLMOD", ACM TOMS 35 (2008).
#include "orbitutte/solve/cholmod_factor.h"

#ifdef ORBITUTTE_HAS_CHOLMOD

#include <cholmod.h>
#include <dlfcn.h>
#include <omp.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <vector>

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
  CholmodFactor(const SparseMatrix& lower, long trailing) : trailing_(trailing) {
    use_one_blas_thread();
    const SerialRegions serial;
    cholmod_l_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_GIVEN;
    common_.postorder = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    cholmod_sparse A = sparse_view(lower);
    order_ = postorder(lower);
    factor_ = cholmod_l_analyze_p(&A, order_.data(), nullptr, 0, &common_);
    if (factor_) cholmod_l_factorize(&A, factor_, &common_);
    if (common_.status != CHOLMOD_OK) fail();
  }

  ~CholmodFactor() override { release(); }
  CholmodFactor(const CholmodFactor&) = delete;
  CholmodFactor& operator=(const CholmodFactor&) = delete;

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override { return run(CHOLMOD_A, B); }

  Eigen::MatrixXd solve_lower(const Eigen::MatrixXd& B) const override {
    Eigen::MatrixXd permuted(B.rows(), B.cols());
    for (Eigen::Index k = 0; k < B.rows(); ++k) permuted.row(k) = B.row(order_[k]);
    return run(CHOLMOD_L, permuted);
  }

  Eigen::MatrixXd solve_upper(const Eigen::MatrixXd& B) const override {
    const Eigen::MatrixXd permuted = run(CHOLMOD_Lt, B);
    Eigen::MatrixXd X(B.rows(), B.cols());
    for (Eigen::Index k = 0; k < B.rows(); ++k) X.row(order_[k]) = permuted.row(k);
    return X;
  }

  // Column j of a supernode is stored densely, with the row indices of all of the supernode's columns.
  Eigen::MatrixXd trailing_block() const override {
    const auto* super = static_cast<const long*>(factor_->super);
    const auto* row_start = static_cast<const long*>(factor_->pi);
    const auto* value_start = static_cast<const long*>(factor_->px);
    const auto* rows = static_cast<const long*>(factor_->s);
    const auto* values = static_cast<const double*>(factor_->x);
    const long leading = static_cast<long>(factor_->n) - trailing_;
    Eigen::MatrixXd block = Eigen::MatrixXd::Zero(trailing_, trailing_);
    for (std::size_t s = 0; s < factor_->nsuper; ++s) {
      const long count = row_start[s + 1] - row_start[s];
      for (long j = std::max(super[s], leading); j < super[s + 1]; ++j) {
        const double* column = values + value_start[s] + (j - super[s]) * count;
        for (long r = 0; r < count; ++r)
          if (const long i = rows[row_start[s] + r]; i >= j) block(i - leading, j - leading) = column[r];
      }
    }
    return block;
  }

 private:
  // The order of A's rows in the factor: a postorder of the leading part's elimination tree, which supernodes
  // need, and the trailing rows as they are.
  std::vector<long> postorder(const SparseMatrix& lower) {
    const long leading = lower.rows() - trailing_;
    std::vector<long> order(lower.rows());
    std::iota(order.begin(), order.end(), 0L);
    SparseMatrix upper = SparseMatrix(lower.topLeftCorner(leading, leading)).transpose();
    cholmod_sparse view = sparse_view(upper);
    view.stype = 1;
    std::vector<long> parent(leading + 1);
    if (!cholmod_l_etree(&view, parent.data(), &common_) ||
        cholmod_l_postorder(parent.data(), leading, nullptr, order.data(), &common_) != leading)
      fail();
    return order;
  }

  Eigen::MatrixXd run(int system, const Eigen::MatrixXd& B) const {
    cholmod_dense b = dense_view(B);
    cholmod_dense* x = cholmod_l_solve(system, factor_, &b, &common_);
    if (!x) throw std::bad_alloc();
    Eigen::MatrixXd X = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x->x), B.rows(), B.cols());
    cholmod_l_free_dense(&x, &common_);
    return X;
  }

  void release() {
    cholmod_l_free_factor(&factor_, &common_);
    cholmod_l_finish(&common_);
  }

  [[noreturn]] void fail() {
    const int status = common_.status;
    const long column = factor_ && status == CHOLMOD_NOT_POSDEF ? order_[factor_->minor] : -1;
    release();
    if (status == CHOLMOD_NOT_POSDEF) throw NotPositiveDefinite(column);
    throw std::bad_alloc();
  }

  mutable cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  long trailing_;
  std::vector<long> order_;  // row k of the factor is row order_[k] of A
};

}  // namespace

std::unique_ptr<SparseFactor> cholmod_factorize(const SparseMatrix& lower, long trailing) {
  return std::make_unique<CholmodFactor>(lower, trailing);
}

}  // namespace orbitutte

#endif
