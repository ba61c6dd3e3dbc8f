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

void LeadingFactor::forward(SinglePoints& y) const {
  SinglePoints permuted(y.rows(), 3);
  for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(k) = y.row(order_[k]);
  y.swap(permuted);
  std::vector<float> pull(3 * most_rows_);
  for (const Stored& s : supernode_) {
    const DenseColumns L = columns_of(s);
    orbitutte::forward(L, y.data() + 3 * s.first_column, pull.data());
    const int* const row = row_.data() + s.first_row + s.columns;
    for (long r = 0, border = L.border(); r < border; ++r)
      for (int c = 0; c < 3; ++c) y(row[r], c) -= pull[r + c * border];
  }
}

void LeadingFactor::backward(SinglePoints& y) const {
  std::vector<float> x(3 * most_rows_);
  for (auto s = supernode_.rbegin(); s != supernode_.rend(); ++s) {
    const DenseColumns L = columns_of(*s);
    const int* const row = row_.data() + s->first_row + s->columns;
    for (long r = 0, border = L.border(); r < border; ++r)
      for (int c = 0; c < 3; ++c) x[r + c * border] = y(row[r], c);
    orbitutte::backward(L, y.data() + 3 * s->first_column, x.data());
  }
  SinglePoints permuted(y.rows(), 3);
  for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(order_[k]) = y.row(k);
  y.swap(permuted);
}

}  // namespace orbitutte
