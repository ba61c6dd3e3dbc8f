// SPDX-License-Identifier: MIT
#include "orbitutte/linear/leading_factor.h"

#include <algorithm>

namespace orbitutte {

void LeadingFactor::reserve(std::size_t rows, std::size_t values) {
  row_.reserve(rows);
  value_.reserve(values);
}

void LeadingFactor::append(const Supernode& supernode) {
  const long first = supernode_.empty() ? 0 : supernode_.back().first_column + supernode_.back().columns;
  supernode_.push_back({first, static_cast<long>(row_.size()), static_cast<long>(value_.size()),
                        supernode.rows, supernode.columns});
  row_.insert(row_.end(), supernode.row, supernode.row + supernode.rows);
  const double* const end = supernode.values + supernode.rows * supernode.columns;
  std::transform(supernode.values, end, std::back_inserter(value_),
                 [](double value) { return static_cast<float>(value); });
  most_rows_ = std::max(most_rows_, supernode.rows);
}

void LeadingFactor::gather(const Stored& s, const SinglePoints& y, float* local) const {
  const int* const row = row_.data() + s.first_row;
  for (long r = 0; r < s.rows; ++r) {
    const float* const from = y.data() + 3L * row[r];
    for (int c = 0; c < 3; ++c) local[r + c * s.rows] = from[c];
  }
}

void LeadingFactor::scatter(const Stored& s, long rows, const float* local, SinglePoints& y) const {
  const int* const row = row_.data() + s.first_row;
  for (long r = 0; r < rows; ++r) {
    float* const to = y.data() + 3L * row[r];
    for (int c = 0; c < 3; ++c) to[c] = local[r + c * s.rows];
  }
}

void LeadingFactor::forward(SinglePoints& y) const {
  SinglePoints permuted(y.rows(), 3);
  for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(k) = y.row(order_[k]);
  y.swap(permuted);
  std::vector<float> local(3 * most_rows_);
  for (const Stored& s : supernode_) {
    gather(s, y, local.data());
    orbitutte::forward(columns_of(s), local.data());
    scatter(s, s.rows, local.data(), y);
  }
}

void LeadingFactor::backward(SinglePoints& y) const {
  std::vector<float> local(3 * most_rows_);
  for (auto s = supernode_.rbegin(); s != supernode_.rend(); ++s) {
    gather(*s, y, local.data());
    orbitutte::backward(columns_of(*s), local.data());
    scatter(*s, s->columns, local.data(), y);
  }
  SinglePoints permuted(y.rows(), 3);
  for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(order_[k]) = y.row(k);
  y.swap(permuted);
}

}  // namespace orbitutte
