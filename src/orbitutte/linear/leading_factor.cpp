// SPDX-License-Identifier: MIT
#include "orbitutte/linear/leading_factor.h"

#include <algorithm>

namespace orbitutte {

void LeadingFactor::reserve(std::size_t rows, std::size_t values) {
  row_.reserve(rows);
  value_.reserve(values);
}

template <typename Real>
void LeadingFactor::append(const Supernode<Real>& supernode) {
  const long first = supernode_.empty() ? 0 : supernode_.back().first_column + supernode_.back().columns;
  supernode_.push_back({first, static_cast<long>(row_.size()), static_cast<long>(value_.size()),
                        supernode.rows, supernode.columns});
  row_.insert(row_.end(), supernode.row, supernode.row + supernode.rows);
  value_.insert(value_.end(), supernode.values, supernode.values + supernode.rows * supernode.columns);
  most_rows_ = std::max(most_rows_, supernode.rows);
}

template <int count>
void LeadingFactor::gather(const Stored& s, const SingleColumns<count>& y, float* local) const {
  const int* const row = row_.data() + s.first_row;
  for (long r = 0; r < s.rows; ++r) {
    const float* const from = y.data() + static_cast<long>(count) * row[r];
    for (int c = 0; c < count; ++c) local[r + c * s.rows] = from[c];
  }
}

template <int count>
void LeadingFactor::scatter(const Stored& s, long rows, const float* local, SingleColumns<count>& y) const {
  const int* const row = row_.data() + s.first_row;
  for (long r = 0; r < rows; ++r) {
    float* const to = y.data() + static_cast<long>(count) * row[r];
    for (int c = 0; c < count; ++c) to[c] = local[r + c * s.rows];
  }
}

template <int count>
void LeadingFactor::forward(SingleColumns<count>& y) const {
  SingleColumns<count> permuted(y.rows(), count);
  for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(k) = y.row(order_[k]);
  y.swap(permuted);
  std::vector<float> local(count * most_rows_);
  for (const Stored& s : supernode_) {
    gather(s, y, local.data());
    orbitutte::forward<count>(columns_of(s), local.data());
    scatter(s, s.rows, local.data(), y);
  }
}

template <int count>
void LeadingFactor::backward(SingleColumns<count>& y) const {
  std::vector<float> local(count * most_rows_);
  for (auto s = supernode_.rbegin(); s != supernode_.rend(); ++s) {
    gather(*s, y, local.data());
    orbitutte::backward<count>(columns_of(*s), local.data());
    scatter(*s, s->columns, local.data(), y);
  }
  SingleColumns<count> permuted(y.rows(), count);
  for (Eigen::Index k = 0; k < y.rows(); ++k) permuted.row(order_[k]) = y.row(k);
  y.swap(permuted);
}

template void LeadingFactor::append(const Supernode<float>& supernode);
template void LeadingFactor::append(const Supernode<double>& supernode);
template void LeadingFactor::forward<1>(SingleColumns<1>& y) const;
template void LeadingFactor::forward<3>(SingleColumns<3>& y) const;
template void LeadingFactor::backward<1>(SingleColumns<1>& y) const;
template void LeadingFactor::backward<3>(SingleColumns<3>& y) const;

}  // namespace orbitutte
