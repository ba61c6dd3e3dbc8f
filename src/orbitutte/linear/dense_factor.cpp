// SPDX-License-Identifier: MIT
#include "orbitutte/linear/dense_factor.h"

#include <dlfcn.h>

#include <algorithm>
#include <vector>

#include "orbitutte/linear/sparse_factor.h"
#include "orbitutte/parallel.h"

extern "C" {
void dpotrf_(const char* uplo, const int* n, double* a, const int* lda, int* info);
void dtrsm_(const char* side, const char* uplo, const char* transpose, const char* diagonal, const int* m,
            const int* n, const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
void dgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n, const int* k,
            const double* alpha, const double* a, const int* lda, const double* b, const int* ldb,
            const double* beta, double* c, const int* ldc);
}

namespace orbitutte {
namespace {

constexpr int tile = 192;

// Rows and columns begin .. begin + count - 1.
struct TileRange {
  int begin, count;
};

std::vector<TileRange> tiles(Eigen::Index begin, Eigen::Index end) {
  std::vector<TileRange> result;
  for (Eigen::Index at = begin; at < end; at += tile)
    result.push_back({static_cast<int>(at), static_cast<int>(std::min<Eigen::Index>(tile, end - at))});
  return result;
}

// pull += L_BO y for up to four columns of L at a time, so that pull is read and written less often.
template <int columns>
void add_columns(const DenseColumns& L, long first, const float* y, float* pull) {
  const float* column[columns];
  for (int j = 0; j < columns; ++j) column[j] = L.values + L.columns + (first + j) * L.stride;
  const long border = L.border();
  for (int c = 0; c < 3; ++c) {
    float factor[columns];
    for (int j = 0; j < columns; ++j) factor[j] = y[3 * (first + j) + c];
    float* __restrict target = pull + c * border;
    for (long i = 0; i < border; ++i) {
      float sum = target[i];
      for (int j = 0; j < columns; ++j) sum += column[j][i] * factor[j];
      target[i] = sum;
    }
  }
}

// Calls visit(row tile, column tile) for every pair in the lower triangle.
template <typename Visit>
void for_each_pair(const std::vector<TileRange>& rows, const Visit& visit) {
  const int count = static_cast<int>(rows.size());
  std::vector<std::pair<int, int>> pairs;
  for (int c = 0; c < count; ++c)
    for (int r = c; r < count; ++r) pairs.emplace_back(r, c);
  parallel_for(static_cast<int>(pairs.size()),
               [&](int k) { visit(rows[pairs[k].first], rows[pairs[k].second]); });
}

}  // namespace

Eigen::MatrixXd zero_lower_triangle(Eigen::Index n) {
  Eigen::MatrixXd A(n, n);
  // The computation takes whole tiles, so a tile on the diagonal is set to zero above it, too.
  for (Eigen::Index column = 0; column < n; ++column) A.col(column).tail(n - column / tile * tile).setZero();
  return A;
}

void partial_cholesky(Eigen::MatrixXd& A, Eigen::Index own) {
  const int n = static_cast<int>(A.rows());
  const double one = 1, minus_one = -1;
  const auto at = [&](int row, int column) { return A.data() + row + static_cast<Eigen::Index>(column) * n; };
  for (const auto& [k, width] : tiles(0, own)) {
    int info = 0;
    dpotrf_("L", &width, at(k, k), &n, &info);
    if (info != 0) throw NotPositiveDefinite(k + info - 1);
    const std::vector<TileRange> below = tiles(k + width, n);
    parallel_for(static_cast<int>(below.size()), [&, k = k, width = width](int i) {
      dtrsm_("R", "L", "T", "N", &below[i].count, &width, &one, at(k, k), &n, at(below[i].begin, k), &n);
    });
    for_each_pair(below, [&, k = k, width = width](const TileRange& row, const TileRange& column) {
      dgemm_("N", "T", &row.count, &column.count, &width, &minus_one, at(row.begin, k), &n,
             at(column.begin, k), &n, &one, at(row.begin, column.begin), &n);
    });
  }
}

void multiply_by_transpose(Eigen::MatrixXd& L) {
  const int n = static_cast<int>(L.rows());
  const double one = 1, zero = 0;
  L.triangularView<Eigen::StrictlyUpper>().setZero();
  Eigen::MatrixXd product(n, n);
  for_each_pair(tiles(0, n), [&](const TileRange& row, const TileRange& column) {
    const int terms =
        column.begin + column.count;  // the columns in which the upper of the two tiles is not zero
    dgemm_("N", "T", &row.count, &column.count, &terms, &one, L.data() + row.begin, &n,
           L.data() + column.begin, &n, &zero,
           product.data() + row.begin + static_cast<Eigen::Index>(column.begin) * n, &n);
  });
  L = std::move(product);
}

void forward(const DenseColumns& L, float* y, float* pull) {
  for (long j = 0; j < L.columns; ++j) {
    const float* column = L.values + j * L.stride;
    float* here = y + 3 * j;
    for (int c = 0; c < 3; ++c) here[c] /= column[j];
    for (long i = j + 1; i < L.columns; ++i)
      for (int c = 0; c < 3; ++c) y[3 * i + c] -= column[i] * here[c];
  }
  std::fill(pull, pull + 3 * L.border(), 0.0F);
  long j = 0;
  for (; j + 4 <= L.columns; j += 4) add_columns<4>(L, j, y, pull);
  for (; j < L.columns; ++j) add_columns<1>(L, j, y, pull);
}

void backward(const DenseColumns& L, float* y, const float* x) {
  using Column = Eigen::Map<const Eigen::VectorXf>;
  const long border = L.border();
  for (long j = L.columns; j-- > 0;) {
    const float* column = L.values + j * L.stride;
    float* here = y + 3 * j;
    const Column below(column + L.columns, border);
    for (int c = 0; c < 3; ++c) here[c] -= below.dot(Column(x + c * border, border));
    for (long i = j + 1; i < L.columns; ++i)
      for (int c = 0; c < 3; ++c) here[c] -= column[i] * y[3 * i + c];
    for (int c = 0; c < 3; ++c) here[c] /= column[j];
  }
}

void use_one_blas_thread() {
  using SetThreads = void (*)(int);
  if (const auto set = reinterpret_cast<SetThreads>(dlsym(RTLD_DEFAULT, "openblas_set_num_threads"))) set(1);
}

}  // namespace orbitutte
