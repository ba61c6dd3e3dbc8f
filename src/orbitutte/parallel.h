// SPDX-License-Identifier: MIT
// Loops over all threads whose results do not depend on how many there are.
#pragma once

#include <algorithm>
#include <exception>
#include <vector>

namespace orbitutte {

/// Calls body(i) for i = 0 .. count - 1, in any order and on any thread; each call may write only what is its
/// own. Of the exceptions that calls throw, the one of the lowest i is rethrown. Serial inside another
/// parallel loop.
template <typename Body>
void parallel_for(int count, const Body& body) {
  std::exception_ptr failure;
  int failed = count;
#pragma omp parallel for schedule(dynamic) if (count > 1)
  for (int i = 0; i < count; ++i) {
    try {
      body(i);
    } catch (...) {
#pragma omp critical(orbitutte_parallel_for)
      if (i < failed) failed = i, failure = std::current_exception();
    }
  }
  if (failure) std::rethrow_exception(failure);
}

/// Calls body(begin, end) for consecutive ranges of 0 .. count - 1 that do not depend on the number of
/// threads.
template <typename Body>
void parallel_ranges(int count, const Body& body) {
  constexpr int length = 8192;
  parallel_for((count + length - 1) / length, [&](int r) {
    body(r * length, static_cast<int>(std::min<long long>(count, (r + 1LL) * length)));
  });
}

/// The sum of term(i) over i = 0 .. count - 1: the same bits whatever the number of threads.
template <typename Term>
double parallel_sum(int count, const Term& term) {
  constexpr int length = 8192;
  std::vector<double> partial((count + length - 1) / length, 0.0);
  parallel_for(static_cast<int>(partial.size()), [&](int r) {
    double sum = 0;
    for (int i = r * length, end = std::min(count - i, length) + i; i < end; ++i) sum += term(i);
    partial[r] = sum;
  });
  double total = 0;
  for (const double sum : partial) total += sum;
  return total;
}

/// The largest term(i) over i = 0 .. count - 1, and 0 at least; a NaN counts for nothing.
template <typename Term>
double parallel_max(int count, const Term& term) {
  double largest = 0;
#pragma omp parallel for schedule(static) reduction(max : largest)
  for (int i = 0; i < count; ++i) largest = std::max(largest, term(i));
  return largest;
}

}  // namespace orbitutte
