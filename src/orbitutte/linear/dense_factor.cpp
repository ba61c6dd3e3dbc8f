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

template <typename Real>
void factorize_leading(Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>& A, Eigen::Index own) {
  const int n = static_cast<int>(A.rows());
  const Real one = 1, minus_one = -1;
  const auto at = [&](int row, int column) { return A.data() + row + static_cast<Eigen::Index>(column) * n; };
  for (const auto& [k, width] : tiles(0, own)) {
    int info = 0;
    Blas<Real>::potrf("L", &width, at(k, k), &n, &info);
    if (info != 0) throw NotPositiveDefinite(k + info - 1);
    const std::vector<TileRange> below = tiles(k + width, n);
    parallel_for(static_cast<int>(below.size()), [&, k = k, width = width](int i) {
      Blas<Real>::trsm("R", "L", "T", "N", &below[i].count, &width, &one, at(k, k), &n, at(below[i].begin, k),
                       &n);
    });
    for_each_pair(below, [&, k = k, width = width](const TileRange& row, const TileRange& column) {
      if (row.begin == column.begin)
        return Blas<Real>::syrk("L", "N", &row.count, &width, &minus_one, at(row.begin, k), &n, &one,
                                at(row.begin, row.begin), &n);
      Blas<Real>::gemm("N", "T", &row.count, &column.count, &width, &minus_one, at(row.begin, k), &n,
                       at(column.begin, k), &n, &one, at(row.begin, column.begin), &n);
    });
  }
}

}  // namespace

Eigen::MatrixXd zero_lower_triangle(Eigen::Index n) {
  Eigen::MatrixXd A(n, n);
  for (Eigen::Index column = 0; column < n; ++column) A.col(column).tail(n - column).setZero();
  return A;
}

void partial_cholesky(Eigen::MatrixXd& A, Eigen::Index own) { factorize_leading(A, own); }
void partial_cholesky(Eigen::MatrixXf& A, Eigen::Index own) { factorize_leading(A, own); }

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
