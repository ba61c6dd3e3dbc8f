// SPDX-License-Identifier: MIT
// Which of n things belong together.
#pragma once

#include <numeric>
#include <utility>
#include <vector>

namespace orbitutte {

/// A partition of 0 .. n-1 that is made coarser by uniting sets (Tarjan's union-find with path halving). The
/// representative of a set is its smallest member.
class DisjointSets {
 public:
  explicit DisjointSets(int n) : parent_(n) { std::iota(parent_.begin(), parent_.end(), 0); }

  /// The smallest member of the set of i.
  int find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  void unite(int i, int j) {
    i = find(i), j = find(j);
    if (i > j) std::swap(i, j);
    parent_[j] = i;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace orbitutte
