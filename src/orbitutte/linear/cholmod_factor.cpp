// SPDX-License-Identifier: MIT
// Y. Chen, T. A. Davis, W. W. Hager, S. Rajamanickam, "Algorithm 887: CHOLMOD", ACM TOMS 35 (2008).
#include "orbitutte/linear/cholmod_factor.h"

#ifdef ORBITUTTE_HAS_CHOLMOD

#include <cholmod.h>
#include <dlfcn.h>

#include <algorithm>
#include <new>
#include <numeric>
#include <vector>

#include "orbitutte/linear/dense_factor.h"

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
    for (std::size_t k = 0; k < factor_->nsuper; ++k) max_rows_ = std::max(max_rows_, supernode(k).L.rows);
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

  void forward(Points& y) const override {
    Points permuted(y.rows(), 3);
    for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(k) = y.row(order_[k]);
    y.swap(permuted);
    std::vector<double> pull(3 * max_rows_);
    for (std::size_t k = 0; k < factor_->nsuper; ++k) {
      const Supernode s = leading_part(k);
      orbitutte::forward(s.L, y.data() + 3 * s.first, pull.data());
      for (long r = 0, border = s.L.border(); r < border; ++r)
        for (int c = 0; c < 3; ++c) y(s.row[s.L.columns + r], c) -= pull[r + c * border];
    }
  }

  void backward(Points& y) const override {
    std::vector<double> x(3 * max_rows_);
    for (std::size_t k = factor_->nsuper; k-- > 0;) {
      const Supernode s = leading_part(k);
      for (long r = 0, border = s.L.border(); r < border; ++r)
        for (int c = 0; c < 3; ++c) x[r + c * border] = y(s.row[s.L.columns + r], c);
      orbitutte::backward(s.L, y.data() + 3 * s.first, x.data());
    }
    Points permuted(y.rows(), 3);
    for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(order_[k]) = y.row(k);
    y.swap(permuted);
  }

  Eigen::MatrixXd schur_complement() const override {
    const long leading = static_cast<long>(factor_->n) - trailing_;
    Eigen::MatrixXd S = Eigen::MatrixXd::Zero(trailing_, trailing_);
    for (std::size_t k = 0; k < factor_->nsuper; ++k) {
      const Supernode s = supernode(k);
      for (long j = std::max(0L, leading - s.first); j < s.L.columns; ++j)
        for (long r = j; r < s.L.rows; ++r)
          S(s.row[r] - leading, s.first + j - leading) = s.L.values[r + j * s.L.stride];
    }
    multiply_by_transpose(S);
    return S;
  }

 private:
  // Consecutive columns with the same rows below them.
  struct Supernode {
    long first;       // the first column
    const long* row;  // the row of L in which each stored row lies
    DenseColumns L;
  };

  Supernode supernode(std::size_t k) const {
    const auto* super = static_cast<const long*>(factor_->super);
    const auto* row_start = static_cast<const long*>(factor_->pi);
    const auto* value_start = static_cast<const long*>(factor_->px);
    const long rows = row_start[k + 1] - row_start[k];
    return {super[k],
            static_cast<const long*>(factor_->s) + row_start[k],
            {static_cast<const double*>(factor_->x) + value_start[k], rows, super[k + 1] - super[k], rows}};
  }

  // The columns of a supernode that are not trailing.
  Supernode leading_part(std::size_t k) const {
    Supernode s = supernode(k);
    s.L.columns = std::clamp(static_cast<long>(factor_->n) - trailing_ - s.first, 0L, s.L.columns);
    return s;
  }

  // The order of A's rows in the factor: a postorder of the leading part's elimination tree, as supernodes
  // require; the trailing rows keep their order.
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
  long max_rows_ = 0;
  std::vector<long> order_;  // row k of the factor is row order_[k] of A
};

}  // namespace

std::unique_ptr<SparseFactor> cholmod_factorize(const SparseMatrix& lower, long trailing) {
  return std::make_unique<CholmodFactor>(lower, trailing);
}

}  // namespace orbitutte

#endif
