// SPDX-License-Identifier: MIT
#include "orbitutte/linear/dense_factor.h"

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
void dsyrk_(const char* uplo, const char* transpose, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* beta, double* c, const int* ldc);
void spotrf_(const char* uplo, const int* n, float* a, const int* lda, int* info);
void strsm_(const char* side, const char* uplo, const char* transpose, const char* diagonal, const int* m,
            const int* n, const float* alpha, const float* a, const int* lda, float* b, const int* ldb);
void sgemm_(const char* transpose_a, const char* transpose_b, const int* m, const int* n, const int* k,
            const float* alpha, const float* a, const int* lda, const float* b, const int* ldb,
            const float* beta, float* c, const int* ldc);
void ssyrk_(const char* uplo, const char* transpose, const int* n, const int* k, const float* alpha,
            const float* a, const int* lda, const float* beta, float* c, const int* ldc);
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

using Four = Eigen::Array4f;
using FourAt = Eigen::Map<const Four>;

template <typename Real>
struct Blas;
template <>
struct Blas<double> {
  static constexpr auto potrf = dpotrf_;
  static constexpr auto trsm = dtrsm_;
  static constexpr auto gemm = dgemm_;
  static constexpr auto syrk = dsyrk_;
};
template <>
struct Blas<float> {
  static constexpr auto potrf = spotrf_;
  static constexpr auto trsm = strsm_;
  static constexpr auto gemm = sgemm_;
  static constexpr auto syrk = ssyrk_;
};

// Some columns of L next to each other, and some vectors along its rows.
template <int count, int vectors>
struct ColumnBlock {
  const float* column[count];
  float* vector[vectors];
  long first, rows;

  ColumnBlock(const DenseColumns& L, long first_column, float* y) : first(first_column), rows(L.rows) {
    for (int k = 0; k < count; ++k) column[k] = L.values + (first + k) * L.stride;
    for (int c = 0; c < vectors; ++c) vector[c] = y + c * rows;
  }

  // Solves with the columns' own rows, and subtracts what they then add to the rows below.
  void forward() const {
    float x[count][vectors];
    for (int k = 0; k < count; ++k) {
      for (int c = 0; c < vectors; ++c) {
        float value = vector[c][first + k];
        for (int j = 0; j < k; ++j) value -= column[j][first + k] * x[j][c];
        vector[c][first + k] = x[k][c] = value / column[k][first + k];
      }
    }
    long i = first + count;
    for (; i + 4 <= rows; i += 4) {
      Four L[count];
      for (int k = 0; k < count; ++k) L[k] = FourAt(column[k] + i);
      for (int c = 0; c < vectors; ++c) {
        Four value = FourAt(vector[c] + i);
        for (int k = 0; k < count; ++k) value -= L[k] * x[k][c];
        Eigen::Map<Four>(vector[c] + i) = value;
      }
    }
    for (; i < rows; ++i)
      for (int c = 0; c < vectors; ++c)
        for (int k = 0; k < count; ++k) vector[c][i] -= column[k][i] * x[k][c];
  }

  // Solves with the transpose for the columns' own rows; those below are known.
  void backward() const {
    Four sums[count][vectors];
    for (int k = 0; k < count; ++k)
      for (int c = 0; c < vectors; ++c) sums[k][c].setZero();
    long i = first + count;
    for (; i + 4 <= rows; i += 4) {
      Four x[vectors];
      for (int c = 0; c < vectors; ++c) x[c] = FourAt(vector[c] + i);
      for (int k = 0; k < count; ++k) {
        const Four L = FourAt(column[k] + i);
        for (int c = 0; c < vectors; ++c) sums[k][c] += L * x[c];
      }
    }
    for (int k = count; k-- > 0;) {
      for (int c = 0; c < vectors; ++c) {
        float value = vector[c][first + k] - sums[k][c].sum();
        for (long j = i; j < rows; ++j) value -= column[k][j] * vector[c][j];
        for (int j = k + 1; j < count; ++j) value -= column[k][first + j] * vector[c][first + j];
        vector[c][first + k] = value / column[k][first + k];
      }
    }
  }
};

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

// Calls visit(begin, end) for consecutive ranges of the columns of a large triangle.
template <typename Visit>
void for_column_ranges(Eigen::Index count, const Visit& visit) {
  constexpr Eigen::Index width = 256;
  parallel_for(static_cast<int>((count + width - 1) / width),
               [&](int k) { visit(k * width, std::min(count, (k + 1) * width)); });
}

template <typename Real>
void factorize_own_rows(const Front<Real>& front) {
  const int size = static_cast<int>(front.size()), border = static_cast<int>(front.border);
  const Real one = 1, minus_one = -1;
  const std::vector<TileRange> border_tiles = tiles(front.own, size);
  for (const auto& [k, width] : tiles(0, front.own)) {
    int info = 0;
    Blas<Real>::potrf("L", &width, &front(k, k), &size, &info);
    if (info != 0) throw NotPositiveDefinite(k + info - 1);
    std::vector<TileRange> below = tiles(k + width, front.own);
    below.insert(below.end(), border_tiles.begin(), border_tiles.end());
    parallel_for(static_cast<int>(below.size()), [&, k = k, width = width](int i) {
      Blas<Real>::trsm("R", "L", "T", "N", &below[i].count, &width, &one, &front(k, k), &size,
                       &front(below[i].begin, k), &size);
    });
    for_each_pair(below, [&, k = k, width = width](const TileRange& row, const TileRange& column) {
      const int stride = column.begin < front.own ? size : border;
      Real* const target = &front(row.begin, column.begin);
      if (row.begin == column.begin)
        return Blas<Real>::syrk("L", "N", &row.count, &width, &minus_one, &front(row.begin, k), &size, &one,
                                target, &stride);
      Blas<Real>::gemm("N", "T", &row.count, &column.count, &width, &minus_one, &front(row.begin, k), &size,
                       &front(column.begin, k), &size, &one, target, &stride);
    });
  }
}

}  // namespace

template <typename Real>
DenseMatrix<Real> zero_lower_triangle(Eigen::Index n) {
  DenseMatrix<Real> A(n, n);
  for_column_ranges(n, [&](Eigen::Index begin, Eigen::Index end) {
    for (Eigen::Index column = begin; column < end; ++column) A.col(column).tail(n - column).setZero();
  });
  return A;
}

template <typename Real>
void add(const DenseMatrix<Real>& update, const std::vector<long>& at, const Front<Real>& front) {
  const long count = static_cast<long>(at.size());
  const long own = std::lower_bound(at.begin(), at.end(), front.own) - at.begin();
  std::vector<long> at_rest(at);
  for (long& row : at_rest) row -= front.own;
  for_column_ranges(count, [&](Eigen::Index begin, Eigen::Index end) {
    for (long c = begin; c < end; ++c) {
      Real* const target = &front(at[c], at[c]);
      const long* const place = c < own ? at.data() : at_rest.data();
      const Real* const column = update.data() + c * count;
      for (long r = c; r < count; ++r) target[place[r] - place[c]] += column[r];
    }
  });
}

template <typename Real>
void partial_cholesky(const Front<Real>& front) {
  factorize_own_rows(front);
}

template DenseMatrix<float> zero_lower_triangle(Eigen::Index n);
template DenseMatrix<double> zero_lower_triangle(Eigen::Index n);
template void add(const DenseMatrix<float>& update, const std::vector<long>& at, const Front<float>& front);
template void add(const DenseMatrix<double>& update, const std::vector<long>& at, const Front<double>& front);
template void partial_cholesky(const Front<float>& front);
template void partial_cholesky(const Front<double>& front);

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

template <int vectors>
void forward(const DenseColumns& L, float* y) {
  long j = 0;
  for (; j + 4 <= L.columns; j += 4) ColumnBlock<4, vectors>(L, j, y).forward();
  for (; j < L.columns; ++j) ColumnBlock<1, vectors>(L, j, y).forward();
}

template <int vectors>
void backward(const DenseColumns& L, float* y) {
  long j = L.columns;
  for (; j % 4 != 0; --j) ColumnBlock<1, vectors>(L, j - 1, y).backward();
  for (; j > 0; j -= 4) ColumnBlock<4, vectors>(L, j - 4, y).backward();
}

template void forward<1>(const DenseColumns& L, float* y);
template void forward<3>(const DenseColumns& L, float* y);
template void backward<1>(const DenseColumns& L, float* y);
template void backward<3>(const DenseColumns& L, float* y);

}  // namespace orbitutte
