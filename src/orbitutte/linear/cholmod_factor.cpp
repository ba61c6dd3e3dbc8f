// SPDX-License-Identifier: MIT
// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, "Algorithm 887: CHOLMOD", ACM TOMS 35 (2008).
#include "orbitutte/linear/cholmod_factor.h"

#ifdef ORBITUTTE_HAS_CHOLMOD

#include <cholmod.h>
#include <dlfcn.h>

#include <new>
#include <numeric>
#include <vector>

#include "orbitutte/linear/dense_factor.h"
#include "orbitutte/linear/multifrontal.h"
#include "orbitutte/memory.h"

namespace orbitutte {
namespace {

static_assert(sizeof(SuiteSparse_long) == sizeof(SparseMatrix::StorageIndex));

// Keeps CHOLMOD's OpenMP regions on the calling thread for as long as it lives. CHOLMOD opens such a region
// for every supernode, which costs more than it gains. OpenMP is present only if CHOLMOD brought it along.
class SerialRegions {
 public:
  SerialRegions() {
    if (get_) before_ = get_();
    if (set_) set_(0);
  }
  ~SerialRegions() {
    if (set_) set_(before_);
  }
  SerialRegions(const SerialRegions&) = delete;
  SerialRegions& operator=(const SerialRegions&) = delete;

 private:
  int (*get_)() = reinterpret_cast<int (*)()>(dlsym(RTLD_DEFAULT, "omp_get_max_active_levels"));
  void (*set_)(int) = reinterpret_cast<void (*)(int)>(dlsym(RTLD_DEFAULT, "omp_set_max_active_levels"));
  int before_ = 1;
};

cholmod_dense dense_view(const Eigen::MatrixXd& matrix) {
  cholmod_dense view = {};
  view.nrow = view.d = static_cast<std::size_t>(matrix.rows());
  view.ncol = static_cast<std::size_t>(matrix.cols());
  view.nzmax = view.nrow * view.ncol;
  // CHOLMOD takes inputs that are not const, but does not write to them.
  view.x = const_cast<double*>(matrix.data());
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

// A matrix's supernodes in the given order, but for a postorder. The trailing rows stay where they are.
class Analysis {
 public:
  Analysis(const SparseMatrix& lower, long trailing) {
    use_one_blas_thread();
    cholmod_l_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
    common_.nmethods = 1;
    common_.method[0].ordering = CHOLMOD_GIVEN;
    common_.postorder = 0;
    common_.supernodal = CHOLMOD_SUPERNODAL;
    order_ = postorder(lower, lower.rows() - trailing);
    cholmod_sparse A = sparse_view(lower);
    if (!order_.empty() || lower.rows() == 0)
      factor_ = cholmod_l_analyze_p(&A, order_.data(), nullptr, 0, &common_);
    if (factor_) return;
    release();
    throw std::bad_alloc();
  }

  ~Analysis() { release(); }
  Analysis(const Analysis&) = delete;
  Analysis& operator=(const Analysis&) = delete;

  SupernodePattern pattern() const {
    const std::size_t count = factor_->nsuper + 1;
    return {std::vector<int>(order_.begin(), order_.end()),
            {static_cast<const long*>(factor_->super), count},
            {static_cast<const long*>(factor_->pi), count},
            {static_cast<const long*>(factor_->s), factor_->ssize}};
  }

  // Row k of the factor is row order()[k] of the matrix.
  const std::vector<long>& order() const { return order_; }
  cholmod_factor* factor() const { return factor_; }
  cholmod_common* common() const { return &common_; }

 private:
  // A postorder of the leading part's elimination tree, as supernodes require; empty if memory does not
  // suffice.
  std::vector<long> postorder(const SparseMatrix& lower, long leading) {
    std::vector<long> order(lower.rows());
    std::iota(order.begin(), order.end(), 0L);
    SparseMatrix upper = SparseMatrix(lower.topLeftCorner(leading, leading)).transpose();
    cholmod_sparse view = sparse_view(upper);
    view.stype = 1;
    std::vector<long> parent(leading + 1);
    const bool is_done =
        cholmod_l_etree(&view, parent.data(), &common_) &&
        cholmod_l_postorder(parent.data(), leading, nullptr, order.data(), &common_) == leading;
    return is_done ? order : std::vector<long>();
  }

  void release() {
    cholmod_l_free_factor(&factor_, &common_);
    cholmod_l_finish(&common_);
  }

  mutable cholmod_common common_;
  cholmod_factor* factor_ = nullptr;
  std::vector<long> order_;
};

class CholmodFactor : public SparseFactor {
 public:
  explicit CholmodFactor(const SparseMatrix& lower) : analysis_(lower, 0) {
    const SerialRegions serial;
    cholmod_sparse A = sparse_view(lower);
    cholmod_l_factorize(&A, analysis_.factor(), analysis_.common());
    const int status = analysis_.common()->status;
    if (status == CHOLMOD_NOT_POSDEF) throw NotPositiveDefinite(analysis_.order()[analysis_.factor()->minor]);
    if (status != CHOLMOD_OK) throw std::bad_alloc();
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& B) const override {
    cholmod_dense b = dense_view(B);
    cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, analysis_.factor(), &b, analysis_.common());
    if (!x) throw std::bad_alloc();
    Eigen::MatrixXd X = Eigen::Map<Eigen::MatrixXd>(static_cast<double*>(x->x), B.rows(), B.cols());
    cholmod_l_free_dense(&x, analysis_.common());
    return X;
  }

 private:
  Analysis analysis_;
};

}  // namespace

std::unique_ptr<SparseFactor> cholmod_factorize(const SparseMatrix& lower) {
  return std::make_unique<CholmodFactor>(lower);
}

template <typename Real>
Elimination<Real> cholmod_eliminate(const SparseMatrix& lower, long trailing) {
  const Analysis analysis(lower, trailing);
  return eliminate_along<Real>(analysis.pattern(), lower, trailing);
}

template Elimination<float> cholmod_eliminate(const SparseMatrix&, long);
template Elimination<double> cholmod_eliminate(const SparseMatrix&, long);

}  // namespace orbitutte

#endif
