// SPDX-License-Identifier: MIT
// Which of n things belongs to which group.
#pragma once

#include <numeric>
#include <vector>

namespace orbitutte {

/// The numbers 0 .. n-1 in groups: those of group g are items[start[g]] .. items[start[g + 1] - 1],
/// ascending.
struct Groups {
  std::vector<int> start = {0};
  std::vector<int> items;

  int size() const { return static_cast<int>(start.size()) - 1; }
};

/// Groups of the i in 0 .. n-1 by group(i), a counting sort; an i of a negative group is left out.
template <typename Group>
Groups group_by(int n, int groups, const Group& group) {
  Groups result;
  result.start.assign(static_cast<std::size_t>(groups) + 1, 0);
  for (int i = 0; i < n; ++i) {
    if (const int g = group(i); g >= 0) ++result.start[g + 1];
  }
  std::partial_sum(result.start.begin(), result.start.end(), result.start.begin());
  result.items.resize(result.start.back());
  std::vector<int> fill(result.start.begin(), result.start.end() - 1);
  for (int i = 0; i < n; ++i) {
    if (const int g = group(i); g >= 0) result.items[fill[g]++] = i;
  }
  return result;
}

}  // namespace orbitutte
