// SPDX-License-Identifier: MIT
#include "orbitutte/linear/multifrontal.h"

#include <algorithm>
#include <numeric>
#include <utility>

#include "orbitutte/linear/dense_factor.h"

namespace orbitutte {
namespace {

// The lower triangle of the matrix in the factor's order, column by column.
struct PermutedLower {
  std::vector<long> start;
  std::vector<int> row;
  std::vector<double> value;
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

PermutedLower permuted(const SparseMatrix& lower, const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[order[k]] = static_cast<int>(k);
  PermutedLower result;
  result.start.assign(order.size() + 1, 0);
  visit_permuted(lower, place, [&](int column, int, double) { ++result.start[column + 1]; });
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.row.resize(result.start.back());
  result.value.resize(result.start.back());
  std::vector<long> fill(result.start.begin(), result.start.end() - 1);
  visit_permuted(lower, place, [&](int column, int row, double value) {
    const long at = fill[column]++;
    result.row[at] = row;
    result.value[at] = value;
  });
  return result;
}

// What the elimination of a supernode adds to the rows of its border: the last rows and columns of a matrix.
struct Update {
  std::span<const long> border;
  Eigen::MatrixXd front;
};

// Adds the update's lower triangle to A; place(row) is the row's index in A.
template <typename Place>
void add(const Update& update, const Place& place, Eigen::MatrixXd& A) {
  std::vector<long> at;
  at.reserve(update.border.size());
  for (const long row : update.border) at.push_back(place(row));
  const long count = static_cast<long>(at.size()), before = update.front.rows() - count;
  for (long c = 0; c < count; ++c) {
    const double* const column = &update.front(before, before + c);
    double* const target = &A(0, at[c]);
    for (long r = c; r < count; ++r) target[at[r]] += column[r];
  }
}

class Fronts {
 public:
  Fronts(const SupernodePattern& pattern, const SparseMatrix& lower, long trailing)
      : pattern_(pattern),
        A_(permuted(lower, pattern.order)),
        leading_(lower.rows() - trailing),
        place_(lower.rows()),
        children_(pattern.count() + 1) {
    for (int s = 0; s < pattern.count(); ++s)
      for (long column = pattern.first[s]; column < pattern.first[s + 1]; ++column)
        supernode_of_.push_back(s);
  }

  Elimination eliminate() {
    Elimination result = {LeadingFactor(pattern_.order), {}};
    result.factor.reserve(pattern_.row.size(), value_count());
    for (int s = 0; s < pattern_.count() && pattern_.first[s] < leading_; ++s) eliminate(s, result.factor);
    result.schur_complement = rest();
    return result;
  }

 private:
  void eliminate(int s, LeadingFactor& factor) {
    const std::span<const long> rows = pattern_.rows(s);
    const long first = pattern_.first[s], own = std::min(pattern_.first[s + 1], leading_) - first;
    for (std::size_t k = 0; k < rows.size(); ++k) place_[rows[k]] = static_cast<int>(k);
    Eigen::MatrixXd front = assembled(s, own);
    try {
      partial_cholesky(front, own);
    } catch (const NotPositiveDefinite& error) {
      throw NotPositiveDefinite(pattern_.order[first + error.column]);
    }
    factor.append({rows.data(), front.data(), front.rows(), own});
    const std::span<const long> border = rows.subspan(own);
    if (border.empty()) return;
    const int parent = border[0] < leading_ ? supernode_of_[border[0]] : pattern_.count();
    children_[parent].push_back({border, std::move(front)});
  }

  // Of the leading columns.
  std::size_t value_count() const {
    std::size_t count = 0;
    for (int s = 0; s < pattern_.count() && pattern_.first[s] < leading_; ++s)
      count += pattern_.rows(s).size() *
               static_cast<std::size_t>(std::min(pattern_.first[s + 1], leading_) - pattern_.first[s]);
    return count;
  }

  // The matrix's own entries in the first `own` columns of a supernode, and what its children add.
  Eigen::MatrixXd assembled(int s, long own) {
    Eigen::MatrixXd front = zero_lower_triangle(static_cast<Eigen::Index>(pattern_.rows(s).size()));
    for (long c = 0; c < own; ++c) {
      const long column = pattern_.first[s] + c;
      for (long at = A_.start[column]; at < A_.start[column + 1]; ++at)
        front(place_[A_.row[at]], c) += A_.value[at];
    }
    for (const Update& update : std::exchange(children_[s], {}))
      add(
          update, [&](long row) { return place_[row]; }, front);
    return front;
  }

  // What is left of the trailing rows.
  Eigen::MatrixXd rest() {
    const long all = static_cast<long>(place_.size());
    Eigen::MatrixXd S = zero_lower_triangle(all - leading_);
    for (long column = leading_; column < all; ++column)
      for (long at = A_.start[column]; at < A_.start[column + 1]; ++at)
        S(A_.row[at] - leading_, column - leading_) += A_.value[at];
    for (const Update& update : children_.back())
      add(
          update, [&](long row) { return row - leading_; }, S);
    return S;
  }

  const SupernodePattern& pattern_;
  const PermutedLower A_;
  const long leading_;
  std::vector<int> supernode_of_;  // of every column
  std::vector<int> place_;         // of a row in the front at hand
  // For every supernode the updates to be added to its front; the last are for the trailing rows.
  std::vector<std::vector<Update>> children_;
};

}  // namespace

Elimination eliminate_along(const SupernodePattern& pattern, const SparseMatrix& lower, long trailing) {
  return Fronts(pattern, lower, trailing).eliminate();
}

}  // namespace orbitutte
