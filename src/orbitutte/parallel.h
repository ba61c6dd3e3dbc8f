// SPDX-License-Identifier: MIT
// Loops over all threads (oneTBB) whose results do not depend on how many there are.
#pragma once

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>
#include <tbb/task_arena.h>

#include <algorithm>
#include <exception>
#include <map>
#include <mutex>
#include <vector>

namespace orbitutte {

/// How many threads the loops below use here.
inline int thread_count() { return tbb::this_task_arena::max_concurrency(); }

/// The calling thread's arena of so many threads (0: as many as the machine has). It is kept, since oneTBB
/// 2021 does not give back most of an arena's memory, 7 kB, when the arena is destroyed.
inline tbb::task_arena& kept_arena(int threads) {
  thread_local std::map<int, tbb::task_arena> arenas;
  const int concurrency = threads == 0 ? int{tbb::task_arena::automatic} : threads;
  return arenas.try_emplace(threads, concurrency).first->second;
}

/// Calls work(), whose loops use so many threads (0: as many as the machine has), and returns what it
/// returns.
template <typename Work>
auto with_threads(int threads, const Work& work) {
  if (threads == 0) return kept_arena(0).execute(work);
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism,
                                    static_cast<std::size_t>(std::max(threads, 2)));
  return kept_arena(threads).execute(work);
}

/// Calls body(i) for i = 0 .. count - 1, in any order and on any thread; each call may write only its own
/// data. If calls throw, the exception of the lowest i is rethrown. Loops may be nested.
template <typename Body>
void parallel_for(int count, const Body& body) {
  std::mutex mutex;
  std::exception_ptr failure;
  int failed = count;
  const auto guarded = [&](int i) {
    try {
      body(i);
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (i < failed) failed = i, failure = std::current_exception();
    }
  };
  if (count == 1) {
    guarded(0);
  } else {
    tbb::parallel_for(0, count, guarded, tbb::simple_partitioner());
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

/// Calls body(begin, end) for one range of 0 .. count - 1 a thread: for bodies that read everything and write
/// what belongs to their range. What they write must not depend on the ranges.
template <typename Body>
void parallel_parts(int count, const Body& body) {
  constexpr int shortest = 10000;
  const int parts = std::max(1, std::min(thread_count(), count / shortest));
  const auto bound = [&](int part) { return static_cast<int>(static_cast<long long>(count) * part / parts); };
  parallel_for(parts, [&](int part) { body(bound(part), bound(part + 1)); });
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

/// The i in 0 .. count - 1 that are chosen, ascending.
template <typename IsChosen>
std::vector<int> parallel_select(int count, const IsChosen& is_chosen) {
  constexpr int length = 8192;
  std::vector<std::vector<int>> chosen((count + length - 1) / length);
  parallel_for(static_cast<int>(chosen.size()), [&](int r) {
    for (int i = r * length, end = std::min(count - i, length) + i; i < end; ++i)
      if (is_chosen(i)) chosen[r].push_back(i);
  });
  std::vector<int> result;
  for (const std::vector<int>& some : chosen) result.insert(result.end(), some.begin(), some.end());
  return result;
}

/// The largest term(i) over i = 0 .. count - 1, or 0 if all are negative; NaN is ignored.
template <typename Term>
double parallel_max(int count, const Term& term) {
  return tbb::parallel_reduce(
      tbb::blocked_range<int>(0, count, 8192), 0.0,
      [&](const tbb::blocked_range<int>& range, double largest) {
        for (int i = range.begin(); i != range.end(); ++i) largest = std::max(largest, term(i));
        return largest;
      },
      [](double a, double b) { return std::max(a, b); });
}

}  // namespace orbitutte
