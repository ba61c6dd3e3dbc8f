// SPDX-License-Identifier: MIT
#include "orbitutte/linear/substructure.h"

#include <algorithm>

#include "orbitutte/linear/dense_factor.h"
#include "orbitutte/memory.h"
#include "orbitutte/parallel.h"

namespace orbitutte {

namespace {

// What the elimination of a block adds to K on its border: the lower triangle.
template <typename Real>
using BlockUpdate = std::shared_ptr<const DenseMatrix<Real>>;

}  // namespace

// A block and its border: the later unknowns to which it is coupled, directly or through eliminated unknowns
// below it.
struct Substructure::Piece {
  long begin = 0, end = 0;
  std::vector<long> border;   // ascending
  std::vector<int> children;  // indices of pieces

  // What goes into the factor, and what comes out besides it; empty once nothing needs it any more. The other
  // precision's update is always empty.
  SparseMatrix equations;
  std::vector<std::vector<long>> rows_of_children;  // those of their borders, in the piece
  std::tuple<BlockUpdate<float>, BlockUpdate<double>> update;

  // The block's columns of L: sparse without children; with children dense, and the border's rows below.
  std::shared_ptr<const LeadingFactor> sparse;
  std::shared_ptr<const Eigen::MatrixXf> dense;

  long own() const { return end - begin; }
  long size() const { return own() + static_cast<long>(border.size()); }
  DenseColumns columns() const { return {dense->data(), size(), own(), size()}; }

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

// The piece's columns of K. K's own entries on the border belong to the parents. In their place stands a
// diagonal that keeps the matrix definite, twice the sum of the couplings; no elimination adds it to
// anything.
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

template <typename Real, typename Piece>
const BlockUpdate<Real>& update_of(const Piece& piece) {
  return std::get<BlockUpdate<Real>>(piece.update);
}

// Eliminates a block without children.
template <typename Real, typename Piece>
void factorize_sparse(Backend backend, Piece& piece) {
  try {
    Elimination<Real> result = eliminate<Real>(piece.equations, backend, piece.size() - piece.own());
    piece.sparse = std::make_shared<LeadingFactor>(std::move(result.factor));
    std::get<BlockUpdate<Real>>(piece.update) = std::make_shared<DenseMatrix<Real>>(std::move(result.update));
  } catch (const NotPositiveDefinite& error) {
    throw NotPositiveDefinite(error.column < 0 ? -1 : piece.begin + std::min(error.column, piece.own() - 1));
  }
}

Eigen::MatrixXf in_single_precision(Eigen::MatrixXf matrix) { return matrix; }
Eigen::MatrixXf in_single_precision(const Eigen::MatrixXd& matrix) { return matrix.cast<float>(); }

template <typename Real, typename Piece>
void factorize_dense(const std::vector<Piece>& pieces, Piece& piece) {
  DenseMatrix<Real> columns = DenseMatrix<Real>::Zero(piece.size(), piece.own());
  auto rest = std::make_shared<DenseMatrix<Real>>(zero_lower_triangle<Real>(piece.size() - piece.own()));
  const Front<Real> front = {piece.own(), rest->rows(), columns.data(), rest->data()};
  for (long column = 0; column < piece.own(); ++column)
    for (SparseMatrix::InnerIterator entry(piece.equations, column); entry; ++entry)
      front(entry.row(), column) += static_cast<Real>(entry.value());
  for (std::size_t k = 0; k < piece.children.size(); ++k)
    if (const auto& update = update_of<Real>(pieces[piece.children[k]]))
      add(*update, piece.rows_of_children[k], front);
  try {
    partial_cholesky(front);
  } catch (const NotPositiveDefinite& error) {
    throw NotPositiveDefinite(piece.begin + error.column);
  }
  piece.dense = std::make_shared<Eigen::MatrixXf>(in_single_precision(std::move(columns)));
  std::get<BlockUpdate<Real>>(piece.update) = std::move(rest);
}

// Does all that goes into two pieces agree to the bit?
template <typename Real, typename Piece>
bool same_input(const std::vector<Piece>& earlier, const std::vector<Piece>& pieces, int k) {
  const Piece &a = earlier[k], &b = pieces[k];
  return a.own() == b.own() && a.children == b.children && a.rows_of_children == b.rows_of_children &&
         equal(a.equations, b.equations) && std::all_of(a.children.begin(), a.children.end(), [&](int child) {
           return update_of<Real>(earlier[child]) == update_of<Real>(pieces[child]);
         });
}

// Finds the piece's border and its equations.
template <typename Piece>
void set_up(const SparseMatrix& lower, const std::vector<Piece>& pieces, Piece& piece) {
  piece.border = coupled_behind(lower, piece.begin, piece.end);
  for (const int child : piece.children)
    for (const long unknown : pieces[child].border)
      if (unknown >= piece.end) piece.border.push_back(unknown);
  sort_uniquely(piece.border);
  piece.equations = piece_matrix(lower, piece);
  for (const int child : piece.children) {
    std::vector<long>& rows = piece.rows_of_children.emplace_back();
    for (const long unknown : pieces[child].border) rows.push_back(piece.place(unknown));
  }
}

}  // namespace

template <typename Real>
void Substructure::eliminate(const SparseMatrix& lower, const SubstructureOptions& options) {
  const auto factorize = [&](int k) {
    Piece& piece = pieces_[k];
    set_up(lower, pieces_, piece);
    if (options.earlier && same_input<Real>(options.earlier->pieces_, pieces_, k)) {
      const Piece& earlier = options.earlier->pieces_[k];
      piece.sparse = earlier.sparse;
      piece.dense = earlier.dense;
      piece.update = earlier.update;
    } else if (!piece.children.empty()) {
      factorize_dense<Real>(pieces_, piece);
    } else if (piece.own() > 0) {
      factorize_sparse<Real>(options.backend, piece);
    }
    if (options.serves_later) return;
    piece.equations = SparseMatrix();
    piece.rows_of_children = {};
    for (const int child : piece.children) pieces_[child].update = {};
  };
  for (const std::vector<int>& level : by_depth_)
    parallel_for(static_cast<int>(level.size()), [&](int k) { factorize(level[k]); });

  DenseMatrix<Real>& S = std::get<DenseMatrix<Real>>(schur_complement_);
  S = zero_lower_triangle<Real>(border_);
  for (long column = 0; column < border_; ++column)
    for (SparseMatrix::InnerIterator entry(lower, border_begin_ + column); entry; ++entry)
      S(entry.row() - border_begin_, column) += static_cast<Real>(entry.value());
  if (pieces_.empty()) return;
  Piece& last = pieces_.back();
  std::vector<long> at = last.border;
  for (long& unknown : at) unknown -= border_begin_;
  if (!at.empty()) add(*update_of<Real>(last), at, Front<Real>{0, border_, nullptr, S.data()});
  if (!options.serves_later) last.update = {};
}

Substructure::Substructure(const SparseMatrix& lower, const std::vector<EliminationBlock>& blocks,
                           const SubstructureOptions& options)
    : border_begin_(blocks.empty() ? 0 : blocks.back().end),
      border_(lower.rows() - border_begin_),
      precision_(options.precision) {
  use_one_blas_thread();
  const int count = static_cast<int>(blocks.size());
  pieces_.resize(count);
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

  SubstructureOptions fitting = options;
  if (options.earlier &&
      (options.earlier->pieces_.size() != pieces_.size() || options.earlier->precision_ != options.precision))
    fitting.earlier = nullptr;
  if (options.precision == Precision::single) {
    eliminate<float>(lower, fitting);
  } else {
    eliminate<double>(lower, fitting);
  }
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
        orbitutte::forward<3>(piece.columns(), columns.data());
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
        orbitutte::backward<3>(piece.columns(), columns.data());
        local = columns;
      }
      y.middleRows(piece.begin, piece.own()) = local.topRows(piece.own());
    });
  }
}

}  // namespace orbitutte
