// SPDX-License-Identifier: MIT
#include "orbitutte/cones/search.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "orbitutte/orbifold/signature.h"

namespace orbitutte {
namespace {

bool contains(const std::vector<int>& vertices, int v) {
  return std::find(vertices.begin(), vertices.end(), v) != vertices.end();
}

// `first`, and then the farthest of `among` from those before, until there are `count`.
std::vector<int> farthest_first(const Points& V, const std::vector<int>& among, std::vector<int> first,
                                int count) {
  if (among.empty()) return {};
  if (first.empty()) first.push_back(among.front());
  std::vector<double> distance(among.size(), std::numeric_limits<double>::infinity());
  for (std::size_t k = 0;; ++k) {
    std::size_t farthest = 0;
    for (std::size_t i = 0; i < among.size(); ++i) {
      distance[i] = std::min(distance[i], (V.row(among[i]) - V.row(first[k])).squaredNorm());
      if (distance[i] > distance[farthest]) farthest = i;
    }
    if (k + 1 < first.size()) continue;
    if (static_cast<int>(first.size()) >= count || !(distance[farthest] > 0)) return first;
    first.push_back(among[farthest]);
  }
}

// About `count` of them, evenly.
std::vector<int> thinned(const std::vector<int>& vertices, int count) {
  const int n = static_cast<int>(vertices.size());
  if (n <= count) return vertices;
  std::vector<int> result(count);
  for (int k = 0; k < count; ++k) result[k] = vertices[static_cast<long long>(k) * n / count];
  return result;
}

bool is_kept(const Freedom& freedom, int vertex) { return contains(freedom.kept, vertex); }

// Do the marks differ in nothing but the vertex? Then an exchange changes nothing.
bool are_alike(const Mark& a, const Mark& b) { return a.angle == b.angle && a.kind == b.kind; }

bool may_exchange(const MarkedTarget& choice, int k, int l, const Freedom& freedom) {
  const Mark &a = choice.target.marks[k], &b = choice.target.marks[l];
  const bool are_held =
      !freedom.orders_move && (is_kept(freedom, choice.cones[k]) || is_kept(freedom, choice.cones[l]));
  return a.kind == b.kind && !are_alike(a, b) && !are_held;
}

}  // namespace

Score score_of(const ScaleSummary& summary, Objective objective) {
  constexpr double resolution = 1e-14;
  Score score;
  score.is_lost = summary.log_least_length < std::log(resolution);
  score.value = objective == Objective::sigma   ? summary.sigma
                : objective == Objective::range ? summary.range
                                                : summary.symmetric_dirichlet;
  return score;
}

Candidates all_places(const Surface& surface) {
  const std::vector<char> is_outer = surface.boundary_vertices();
  std::vector<char> is_used(surface.vertex_count(), 0);
  for (const int v : surface.triangles.reshaped()) is_used[v] = 1;
  Candidates all;
  for (int v = 0; v < surface.vertex_count(); ++v)
    if (is_used[v]) (is_outer[v] ? all.on_boundary : all.inside).push_back(v);
  return all;
}

Candidates spread_candidates(const Surface& surface, const Candidates& first, int count) {
  const Candidates all = all_places(surface);
  return {farthest_first(surface.V, all.inside, first.inside, count),
          farthest_first(surface.V, all.on_boundary, first.on_boundary, count)};
}

std::vector<std::vector<int>> doubling_rings(const Neighbors& neighbors, int vertex) {
  constexpr int farthest = 32;
  std::vector<char> is_reached(neighbors.start.size() - 1, 0);
  is_reached[vertex] = 1;
  std::vector<int> ring = {vertex};
  std::vector<std::vector<int>> result;
  for (int distance = 1; distance <= farthest && !ring.empty(); ++distance) {
    std::vector<int> next;
    for (const int v : ring)
      for (int k = neighbors.start[v]; k < neighbors.start[v + 1]; ++k)
        if (const int u = neighbors.neighbor[k]; !std::exchange(is_reached[u], 1)) next.push_back(u);
    ring = std::move(next);
    if ((distance & (distance - 1)) != 0) continue;
    result.push_back(ring);
    std::sort(result.back().begin(), result.back().end());
  }
  return result;
}

ConeSearch::ConeSearch(ScaleField& field, const Surface& surface, const Neighbors& neighbors,
                       Objective objective)
    : field_(field), neighbors_(neighbors), objective_(objective), is_outer_(surface.boundary_vertices()) {}

Score ConeSearch::score(const MarkedTarget& choice) {
  const bool needs_all = objective_ == Objective::symmetric_dirichlet;
  return score_of(needs_all ? field_.summary(choice) : field_.spread(choice), objective_);
}

bool ConeSearch::is_possible(const MarkedTarget& choice) const {
  const std::vector<int>& cones = choice.cones;
  for (std::size_t k = 0; k < cones.size(); ++k)
    if (std::count(cones.begin(), cones.end(), cones[k]) > 1) return false;
  if (!are_opposite(choice.target.marks)) return true;
  const auto begin = neighbors_.neighbor.begin();
  return std::find(begin + neighbors_.start[cones[0]], begin + neighbors_.start[cones[0] + 1], cones[1]) ==
         begin + neighbors_.start[cones[0] + 1];
}

void ConeSearch::look_at_best(const MarkedTarget& choice) {
  if (first_look_.field) first_look_.sigma = first_look_.field->sigma(choice);
}

bool ConeSearch::is_promising(const MarkedTarget& choice, const Score& best) const {
  if (!first_look_.field || best.is_lost) return true;
  return first_look_.field->sigma(choice) <= (1 + first_look_.margin) * first_look_.sigma;
}

bool ConeSearch::try_vertex(MarkedTarget& choice, int mark, int vertex, Score& best) {
  const int before = choice.cones[mark];
  choice.cones[mark] = vertex;
  if (is_possible(choice) && is_promising(choice, best))
    if (const Score now = score(choice); now.is_clearly_below(best)) {
      best = now;
      look_at_best(choice);
      return true;
    }
  choice.cones[mark] = before;
  return false;
}

bool ConeSearch::try_candidates(MarkedTarget& choice, int mark, const std::vector<int>& candidates,
                                Score& best) {
  bool is_better = false;
  for (const int v : candidates)
    if (!contains(choice.cones, v)) is_better |= try_vertex(choice, mark, v, best);
  return is_better;
}

bool ConeSearch::try_exchanges(MarkedTarget& choice, const Freedom& freedom, Score& best) {
  bool is_better = false;
  const int count = static_cast<int>(choice.cones.size());
  for (int k = 0; k < count; ++k)
    for (int l = k + 1; l < count; ++l) {
      if (!may_exchange(choice, k, l, freedom)) continue;
      std::swap(choice.cones[k], choice.cones[l]);
      if (const Score now = score(choice); now.is_clearly_below(best)) {
        best = now;
        look_at_best(choice);
        is_better = true;
      } else {
        std::swap(choice.cones[k], choice.cones[l]);
      }
    }
  return is_better;
}

Score ConeSearch::descend(MarkedTarget& choice, const Candidates& candidates, const Freedom& freedom) {
  Score best = score(choice);
  look_at_best(choice);
  const int marks = static_cast<int>(choice.cones.size());
  // Candidates that were tried are no better before something else has changed.
  for (int k = -1, idle = 0; idle <= marks; k = k + 1 < marks ? k + 1 : -1)
    if (k < 0)
      idle = try_exchanges(choice, freedom, best) ? 0 : idle + 1;
    else
      idle = !is_kept(freedom, choice.cones[k]) &&
                     try_candidates(choice, k, candidates.of(choice.target, k), best)
                 ? 1
                 : idle + 1;
  return best;
}

std::vector<int> ConeSearch::rings_around(int vertex) const {
  constexpr int of_each = 8;
  std::vector<int> result;
  for (std::vector<int> ring : doubling_rings(neighbors_, vertex)) {
    std::erase_if(ring, [&](int v) { return is_outer_[v] != is_outer_[vertex]; });
    for (const int v : thinned(ring, of_each)) result.push_back(v);
  }
  return result;
}

Score ConeSearch::polish(MarkedTarget& choice, const Freedom& freedom) {
  constexpr int most_sweeps = 20;
  Score best = score(choice);
  look_at_best(choice);
  const int marks = static_cast<int>(choice.cones.size());
  int steps_left = most_sweeps * (marks + 1);
  for (int k = -1, idle = 0; idle <= marks && steps_left-- > 0; k = k + 1 < marks ? k + 1 : -1) {
    const bool helps = k < 0 ? try_exchanges(choice, freedom, best)
                             : !is_kept(freedom, choice.cones[k]) &&
                                   try_candidates(choice, k, rings_around(choice.cones[k]), best);
    idle = helps ? 0 : idle + 1;
  }
  return best;
}

}  // namespace orbitutte
