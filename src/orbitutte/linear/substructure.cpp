// SPDX-License-Identifier: MIT
#include "orbitutte/linear/substructure.h"

#include <algorithm>

#include "orbitutte/linear/dense_factor.h"
#include "orbitutte/memory.h"
#include "orbitutte/parallel.h"

namespace orbitutte {

// A block and its border: the later unknowns to which it is coupled, directly or through eliminated unknowns
// below it.
struct Substructure::Piece {
  long begin = 0, end = 0;
  std::vector<long> border;   // ascending
  std::vector<int> children;  // indices of pieces
  // Without children: the matrix that is factorised, its factor, and what the elimination adds to K on the
  // border.
  SparseMatrix equations;
  std::shared_ptr<const LeadingFactor> sparse;
  std::shared_ptr<const Eigen::MatrixXd> sparse_update;
  // With children: the block's columns of L, with the border's rows below, and what the elimination adds to K
  // on the border; empty once the parent has taken it.
  Eigen::MatrixXf front;
  Eigen::MatrixXd dense_update;

  long own() const { return end - begin; }
  long size() const { return own() + static_cast<long>(border.size()); }

  const Eigen::MatrixXd& update() const { return sparse_update ? *sparse_update : dense_update; }
  DenseColumns dense() const { return {front.data(), size(), own(), size()}; }

  // The index within the piece of an unknown of the block or its border.
  long place(long unknown) const {
    if (unknown < end) return unknown - begin;
    return own() + (std::lower_bound(border.begin(), border.end(), unknown) - border.begin());
  }
};

namespace {

using ByColumns = Eigen::Matrix<float, Eigen::Dynamic, 3>;

void sort_uniquely(std::vector<long>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

// The unknowns from `end` on to which columns begin .. end - 1 are coupled.
std::vector<long> coupled_behind(const SparseMatrix& lower, long begin, long end) {
  std::vector<long> result;
  for (long column = begin; column < end; ++column)
    for (SparseMatrix::InnerIterator entry(lower, column); entry; ++entry)
      if (entry.row() >= end) result.push_back(entry.row());
  sort_uniquely(result);
  return result;
}

template <typename Piece>
SparseMatrix piece_matrix(const SparseMatrix& lower, const Piece& piece) {
  const long nonzeros = lower.outerIndexPtr()[piece.end] - lower.outerIndexPtr()[piece.begin];
  SparseMatrix A(piece.size(), piece.size());
  A.resizeNonZeros(nonzeros + piece.size() - piece.own());
  Eigen::VectorXd coupling = Eigen::VectorXd::Zero(piece.size() - piece.own());
  long at = 0;
  for (long column = 0; column < piece.own(); ++column) {
    A.outerIndexPtr()[column] = at;
    for (SparseMatrix::InnerIterator entry(lower, piece.begin + column); entry; ++entry) {
      const long row = piece.place(entry.row());
      if (row >= piece.own()) coupling[row - piece.own()] -= entry.value();
      A.innerIndexPtr()[at] = row;
      A.valuePtr()[at++] = entry.value();
    }
  }
  for (long k = 0; k < coupling.size(); ++k) {
    A.outerIndexPtr()[piece.own() + k] = at;
    A.innerIndexPtr()[at] = piece.own() + k;
    A.valuePtr()[at++] = coupling[k] > 0 ? 2 * coupling[k] : 1.0;
  }
  A.outerIndexPtr()[piece.size()] = at;
  return A;
}

// Eliminates a block without children. K's own entries on the border belong to the parents. In their place
// stands a diagonal that keeps the matrix definite, twice the sum of the couplings; it is subtracted
// afterwards.
template <typename Piece>
void factorize_sparse(const SparseMatrix& lower, Backend backend, const Piece* earlier, Piece& piece) {
  if (piece.own() == 0) return;
  piece.equations = piece_matrix(lower, piece);
  const long border = piece.size() - piece.own();
  if (earlier && earlier->own() == piece.own() && equal(earlier->equations, piece.equations)) {
    piece.sparse = earlier->sparse;
    piece.sparse_update = earlier->sparse_update;
  } else {
    try {
      Elimination result = eliminate(piece.equations, backend, border);
      const long* const start = piece.equations.outerIndexPtr() + piece.own();
      for (long k = 0; k < border; ++k) result.schur_complement(k, k) -= piece.equations.valuePtr()[start[k]];
      piece.sparse = std::make_shared<LeadingFactor>(std::move(result.factor));
      piece.sparse_update = std::make_shared<Eigen::MatrixXd>(std::move(result.schur_complement));
    } catch (const NotPositiveDefinite& error) {
      throw NotPositiveDefinite(error.column < 0 ? -1
                                                 : piece.begin + std::min(error.column, piece.own() - 1));
    }
  }
}

// Adds the lower triangle of a piece's update to A; `place(unknown)` is the unknown's index in A.
template <typename Piece, typename Place>
void add_update(const Piece& from, const Place& place, Eigen::MatrixXd& A) {
  std::vector<long> at;
  for (const long unknown : from.border) at.push_back(place(unknown));
  const long count = static_cast<long>(at.size());
  for (long c = 0; c < count; ++c) {
    const double* column = &from.update()(0, c);
    double* target = &A(0, at[c]);
    for (long r = c; r < count; ++r) target[at[r]] += column[r];
  }
}

template <typename Piece>
void factorize_dense(const SparseMatrix& lower, std::vector<Piece>& pieces, Piece& piece) {
  Eigen::MatrixXd A = zero_lower_triangle(piece.size());
  for (long column = 0; column < piece.own(); ++column)
    for (SparseMatrix::InnerIterator entry(lower, piece.begin + column); entry; ++entry)
      A(piece.place(entry.row()), column) += entry.value();
  for (const int child : piece.children) {
    add_update(
        pieces[child], [&](long unknown) { return piece.place(unknown); }, A);
    pieces[child].dense_update.resize(0, 0);
  }
  try {
    partial_cholesky(A, piece.own());
  } catch (const NotPositiveDefinite& error) {
    throw NotPositiveDefinite(piece.begin + error.column);
  }
  piece.front = A.leftCols(piece.own()).template cast<float>();
  const long border = piece.size() - piece.own();
  piece.dense_update = A.bottomRightCorner(border, border);
}

}  // namespace

Substructure::Substructure(const SparseMatrix& lower, const std::vector<EliminationBlock>& blocks,
                           Backend backend, const Substructure* earlier)
    : border_begin_(blocks.empty() ? 0 : blocks.back().end), border_(lower.rows() - border_begin_) {
  use_one_blas_thread();
  const int count = static_cast<int>(blocks.size());
  pieces_.resize(count);
  if (earlier && static_cast<int>(earlier->pieces_.size()) != count) earlier = nullptr;
  std::vector<std::size_t> depth(count, 0);
  for (int k = count; k-- > 0;) {
    pieces_[k].begin = blocks[k].begin;
    pieces_[k].end = blocks[k].end;
    if (blocks[k].parent >= 0) depth[k] = depth[blocks[k].parent] + 1;
    if (depth[k] >= by_depth_.size()) by_depth_.resize(depth[k] + 1);
    by_depth_[depth[k]].push_back(k);
  }
  std::reverse(by_depth_.begin(), by_depth_.end());
  for (int k = 0; k < count; ++k)
    if (blocks[k].parent >= 0) pieces_[blocks[k].parent].children.push_back(k);

  for (const std::vector<int>& level : by_depth_) {
    const auto eliminate = [&](int k) {
      Piece& piece = pieces_[level[k]];
      piece.border = coupled_behind(lower, piece.begin, piece.end);
      for (const int child : piece.children)
        for (const long unknown : pieces_[child].border)
          if (unknown >= piece.end) piece.border.push_back(unknown);
      sort_uniquely(piece.border);
      if (piece.children.empty()) {
        factorize_sparse(lower, backend, earlier ? &earlier->pieces_[level[k]] : nullptr, piece);
      } else {
        factorize_dense(lower, pieces_, piece);
      }
    };
    parallel_for(static_cast<int>(level.size()), eliminate);
  }

  schur_complement_ = Eigen::MatrixXd::Zero(border_, border_);
  for (long column = 0; column < border_; ++column)
    for (SparseMatrix::InnerIterator entry(lower, border_begin_ + column); entry; ++entry)
      schur_complement_(entry.row() - border_begin_, column) += entry.value();
  if (!pieces_.empty() && !pieces_.back().border.empty()) {
    add_update(
        pieces_.back(), [&](long unknown) { return unknown - border_begin_; }, schur_complement_);
    pieces_.back().dense_update.resize(0, 0);
  }
  schur_complement_.triangularView<Eigen::StrictlyUpper>() = schur_complement_.transpose();
}

void Substructure::release_what_solving_does_not_need() {
  for (Piece& piece : pieces_) {
    piece.equations = SparseMatrix();
    piece.sparse_update.reset();
  }
  schur_complement_.resize(0, 0);
}

Substructure::~Substructure() = default;
Substructure::Substructure(Substructure&&) noexcept = default;

void Substructure::forward(SinglePoints& y) const {
  std::vector<SinglePoints> pull(pieces_.size());  // what each piece adds to y on its border
  const auto take = [&](const Piece& piece, SinglePoints& local) {
    for (const int child : piece.children) {
      const std::vector<long>& border = pieces_[child].border;
      for (std::size_t k = 0; k < border.size(); ++k)
        local.row(piece.place(border[k])) += pull[child].row(static_cast<long>(k));
      pull[child].resize(0, 3);
    }
  };
  for (const std::vector<int>& level : by_depth_) {
    parallel_for(static_cast<int>(level.size()), [&](int k) {
      const Piece& piece = pieces_[level[k]];
      SinglePoints local = SinglePoints::Zero(piece.size(), 3);
      local.topRows(piece.own()) = y.middleRows(piece.begin, piece.own());
      take(piece, local);
      if (piece.sparse) {
        piece.sparse->forward(local);
      } else if (piece.own() > 0) {
        ByColumns columns = local;
        orbitutte::forward<3>(piece.dense(), columns.data());
        local = columns;
      }
      y.middleRows(piece.begin, piece.own()) = local.topRows(piece.own());
      pull[level[k]] = local.bottomRows(piece.size() - piece.own());
    });
  }
  if (pieces_.empty()) return;
  const std::vector<long>& border = pieces_.back().border;
  for (std::size_t k = 0; k < border.size(); ++k) y.row(border[k]) += pull.back().row(static_cast<long>(k));
}

void Substructure::backward(SinglePoints& y) const {
  for (auto level = by_depth_.rbegin(); level != by_depth_.rend(); ++level) {
    parallel_for(static_cast<int>(level->size()), [&](int k) {
      const Piece& piece = pieces_[(*level)[k]];
      if (piece.own() == 0) return;
      SinglePoints local(piece.size(), 3);
      local.topRows(piece.own()) = y.middleRows(piece.begin, piece.own());
      for (std::size_t b = 0; b < piece.border.size(); ++b)
        local.row(piece.own() + static_cast<long>(b)) = y.row(piece.border[b]);
      if (piece.sparse) {
        piece.sparse->backward(local);
      } else {
        ByColumns columns = local;
        orbitutte::backward<3>(piece.dense(), columns.data());
        local = columns;
      }
      y.middleRows(piece.begin, piece.own()) = local.topRows(piece.own());
    });
  }
}

}  // namespace orbitutte
