// SPDX-License-Identifier: MIT
// G. A. Croes, "A method for solving traveling-salesman problems", Operations Research 6 (1958): exchanges of
// two legs.
#include "orbitutte/cut/tour.h"

#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include "orbitutte/cut/cut.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int most_enumerated = 8;

// The lengths of all legs.
struct Legs {
  Eigen::MatrixXd between;

  // From where the tours begin; zero where they may begin anywhere.
  Eigen::VectorXd from_start;
  bool has_start = false;

  double length(const std::vector<int>& tour) const {
    double sum = from_start[tour.front()];
    for (std::size_t k = 1; k < tour.size(); ++k) sum += between(tour[k - 1], tour[k]);
    return sum;
  }
};

Legs legs_between(const Surface& surface, const std::vector<int>& marks, int from) {
  const EdgeGraph graph = edge_length_graph(surface);
  const int count = static_cast<int>(marks.size());
  Legs legs = {Eigen::MatrixXd(count, count), Eigen::VectorXd::Zero(count), from >= 0};
  parallel_for(count, [&](int k) {
    const std::vector<double> distance = distances(graph, {marks[k]});
    for (int j = 0; j < count; ++j) legs.between(k, j) = distance[marks[j]];
    if (from >= 0) legs.from_start[k] = distance[from];
  });
  return legs;
}

std::vector<std::vector<int>> all_tours(const Legs& legs) {
  std::vector<int> order(legs.between.rows());
  std::iota(order.begin(), order.end(), 0);
  std::vector<std::pair<double, std::vector<int>>> tours;
  do {
    if (legs.has_start || order.front() <= order.back()) tours.emplace_back(legs.length(order), order);
  } while (std::next_permutation(order.begin(), order.end()));
  std::sort(tours.begin(), tours.end());
  std::vector<std::vector<int>> result;
  result.reserve(tours.size());
  for (auto& [length, tour] : tours) result.push_back(std::move(tour));
  return result;
}

// Always on to the nearest that was left.
std::vector<int> greedy_tour(const Legs& legs, int first) {
  const int count = static_cast<int>(legs.between.rows());
  std::vector<int> tour = {first};
  std::vector<char> is_taken(count, 0);
  is_taken[first] = 1;
  while (static_cast<int>(tour.size()) < count) {
    int nearest = -1;
    for (int k = 0; k < count; ++k)
      if (!is_taken[k] && (nearest < 0 || legs.between(tour.back(), k) < legs.between(tour.back(), nearest)))
        nearest = k;
    is_taken[nearest] = 1;
    tour.push_back(nearest);
  }
  return tour;
}

// Turns parts of the tour around as long as that makes it shorter.
void exchange_legs(const Legs& legs, std::vector<int>& tour) {
  for (bool is_shorter = true; is_shorter;) {
    is_shorter = false;
    for (std::size_t i = 0; i < tour.size(); ++i)
      for (std::size_t j = i + 2; j <= tour.size(); ++j) {
        std::vector<int> other = tour;
        std::reverse(other.begin() + i, other.begin() + j);
        if (!(legs.length(other) < legs.length(tour) * (1 - 1e-12))) continue;
        tour = std::move(other);
        is_shorter = true;
      }
  }
}

std::vector<int> shortened_tour(const Legs& legs) {
  std::vector<int> best;
  for (int first = 0; first < legs.between.rows(); ++first) {
    std::vector<int> tour = greedy_tour(legs, first);
    exchange_legs(legs, tour);
    if (best.empty() || legs.length(tour) < legs.length(best)) best = std::move(tour);
  }
  return best;
}

}  // namespace

std::vector<std::vector<int>> short_tours(const Surface& surface, const std::vector<int>& marks, int from,
                                          int count) {
  if (marks.empty()) return {{}};
  const Legs legs = legs_between(surface, marks, from);
  if (static_cast<int>(marks.size()) > most_enumerated) return {shortened_tour(legs)};
  std::vector<std::vector<int>> tours = all_tours(legs);
  if (static_cast<int>(tours.size()) > count) tours.resize(count);
  return tours;
}

}  // namespace orbitutte
