// SPDX-License-Identifier: MIT
#include "orbitutte/linear/multifrontal.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "orbitutte/linear/dense_factor.h"

namespace orbitutte {
namespace {

// The lower triangle of the matrix in the factor's order, column by column.
template <typename Real>
struct PermutedLower {
  std::vector<long> start;
  std::vector<int> row;
  std::vector<Real> value;
};

// Calls visit(column, row, value) for every entry, in the factor's order.
template <typename Visit>
void visit_permuted(const SparseMatrix& lower, const std::vector<int>& place, const Visit& visit) {
  for (long j = 0; j < lower.cols(); ++j) {
    for (SparseMatrix::InnerIterator entry(lower, j); entry; ++entry) {
      const auto [column, row] = std::minmax(place[j], place[entry.row()]);
      visit(column, row, entry.value());
    }
  }
}

template <typename Real>
PermutedLower<Real> permuted(const SparseMatrix& lower, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  PermutedLower<Real> result;
  result.start.assign(order.size() + 1, 0);
  visit_permuted(lower, place, [&](int column, int, double) { ++result.start[column + 1]; });
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.row.resize(result.start.back());
  result.value.resize(result.start.back());
  std::vector<long> fill(result.start.begin(), result.start.end() - 1);
  visit_permuted(lower, place, [&](int column, int row, double value) {
    const long at = fill[column]++;
    result.row[at] = row;
    result.value[at] = static_cast<Real>(value);
  });
  return result;
}

// What the elimination of a supernode adds to the rows of its border.
template <typename Real>
struct Update {
  std::span<const long> border;
  DenseMatrix<Real> values;
};

template <typename Real>
class Fronts {
 public:
  Fronts(const SupernodePattern& pattern, const SparseMatrix& lower, long trailing)
      : pattern_(pattern),
        A_(permuted<Real>(lower, pattern.order)),
        leading_(lower.rows() - trailing),
        place_(lower.rows()),
        children_(pattern.count() + 1) {
    for (int s = 0; s < pattern.count(); ++s)
      for (long column = pattern.first[s]; column < pattern.first[s + 1]; ++column)
        supernode_of_.push_back(s);
  }

  Elimination<Real> eliminate() {
    Elimination<Real> result = {LeadingFactor(pattern_.order), {}};
    result.factor.reserve(pattern_.row.size(), value_count());
    for (int s = 0; s < pattern_.count() && pattern_.first[s] < leading_; ++s) eliminate(s, result.factor);
    const long trailing = static_cast<long>(place_.size()) - leading_;
    std::iota(place_.begin() + leading_, place_.end(), 0);
    result.update = zero_lower_triangle<Real>(trailing);
    take_children(pattern_.count(), {0, trailing, nullptr, result.update.data()});
    return result;
  }

 private:
  void eliminate(int s, LeadingFactor& factor) {
    const std::span<const long> rows = pattern_.rows(s);
    const long first = pattern_.first[s], own = std::min(pattern_.first[s + 1], leading_) - first;
    const std::span<const long> border = rows.subspan(own);
    for (std::size_t k = 0; k < rows.size(); ++k) place_[rows[k]] = static_cast<int>(k);
    columns_.assign(rows.size() * own, 0);
    DenseMatrix<Real> rest = zero_lower_triangle<Real>(static_cast<Eigen::Index>(border.size()));
    const Front<Real> front = {own, rest.rows(), columns_.data(), rest.data()};
    for (long c = 0; c < own; ++c)
      for (long at = A_.start[first + c]; at < A_.start[first + c + 1]; ++at)
        front(place_[A_.row[at]], c) += A_.value[at];
    take_children(s, front);
    try {
      partial_cholesky(front);
    } catch (const NotPositiveDefinite& error) {
      throw NotPositiveDefinite(pattern_.order[first + error.column]);
    }
    factor.append(LeadingFactor::Supernode<Real>{rows.data(), front.columns, front.size(), own});
    if (border.empty()) return;
    const int parent = border[0] < leading_ ? supernode_of_[border[0]] : pattern_.count();
    children_[parent].push_back({border, std::move(rest)});
  }

  std::size_t value_count() const {
    std::size_t count = 0;
    for (int s = 0; s < pattern_.count(); ++s)
      count += pattern_.rows(s).size() * static_cast<std::size_t>(pattern_.first[s + 1] - pattern_.first[s]);
    return count;
  }

  // Adds what the children of a supernode leave to its front, and forgets it.
  void take_children(int s, const Front<Real>& front) {
    for (const Update<Real>& update : std::exchange(children_[s], {})) {
      std::vector<long> at;
      at.reserve(update.border.size());
      for (const long row : update.border) at.push_back(place_[row]);
      add(update.values, at, front);
    }
  }

  const SupernodePattern& pattern_;
  const PermutedLower<Real> A_;
  const long leading_;
  std::vector<int> supernode_of_;  // of every column
  std::vector<int> place_;         // of a row in the front at hand
  std::vector<Real> columns_;      // of the front at hand
  // For every supernode the updates to be added to its front; the last are for the trailing rows.
  std::vector<std::vector<Update<Real>>> children_;
};

}  // namespace

template <typename Real>
Elimination<Real> eliminate_along(const SupernodePattern& pattern, const SparseMatrix& lower, long trailing) {
  return Fronts<Real>(pattern, lower, trailing).eliminate();
}

template Elimination<float> eliminate_along(const SupernodePattern&, const SparseMatrix&, long);
template Elimination<double> eliminate_along(const SupernodePattern&, const SparseMatrix&, long);

}  // namespace orbitutte
