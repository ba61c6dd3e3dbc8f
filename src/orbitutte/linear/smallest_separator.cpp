// SPDX-License-Identifier: MIT
// E. Dinic, "Algorithm for solution of a problem of maximum flow in networks with power estimation", Soviet
// Math. Doklady 11 (1970), with each vertex split into an entry and an exit.
#include "orbitutte/linear/smallest_separator.h"

#include <algorithm>

namespace orbitutte {
namespace {

constexpr int no_vertex = -1, outside = -2;  // what comes before or after a vertex on its path
constexpr int out_of_reach = -1, tried = -2;

// As many paths through a band as possible that share no vertex. Node 2 v is the entry of vertex v, node 2 v
// + 1 its exit.
class DisjointPaths {
 public:
  explicit DisjointPaths(const Band& band)
      : band_(band),
        next_(band.count(), no_vertex),
        previous_(band.count(), no_vertex),
        level_(2 * band.count()),
        arc_(2 * band.count()) {
    while (find_levels()) {
      std::fill(arc_.begin(), arc_.end(), 0);
      for (int v = 0; v < band.count(); ++v)
        if (band.first[v] && previous_[v] != outside) augment(v);
    }
  }

  // Which nodes can still be reached tells where the separator lies (L. Ford, D. Fulkerson, Canadian J. Math.
  // 8 (1956)).
  PlaceInBand place(int v) const {
    if (level_[entry(v)] == out_of_reach) return PlaceInBand::behind;
    return level_[exit(v)] == out_of_reach ? PlaceInBand::within : PlaceInBand::before;
  }

 private:
  static int entry(int v) { return 2 * v; }
  static int exit(int v) { return 2 * v + 1; }

  // The residual graph's arcs that leave a node. An entry leads to its exit, or, if a path takes the vertex,
  // back to where that comes from. An exit leads to the entries of neighbours and of a vertex that is taken.
  int arc_count(int node) const {
    const int v = node / 2;
    return node == entry(v) ? 1 : 1 + band_.start[v + 1] - band_.start[v];
  }
  // The k-th one's end; -1 if it is used up.
  int end_of_arc(int node, int k) const {
    const int v = node / 2;
    const bool is_taken = next_[v] != no_vertex;
    if (node == entry(v)) return !is_taken ? exit(v) : previous_[v] >= 0 ? exit(previous_[v]) : -1;
    if (k == 0) return is_taken ? entry(v) : -1;
    const int neighbor = band_.neighbor[band_.start[v] + k - 1];
    return neighbor == next_[v] ? -1 : entry(neighbor);
  }
  bool leads_outside(int node) const {
    const int v = node / 2;
    return node == exit(v) && band_.second[v] && next_[v] != outside;
  }

  // The number of arcs from the first side to each node. Is the second side in reach?
  bool find_levels() {
    std::fill(level_.begin(), level_.end(), out_of_reach);
    queue_.clear();
    for (int v = 0; v < band_.count(); ++v)
      if (band_.first[v]) reach(entry(v), 0);
    bool is_reached = false;
    for (std::size_t k = 0; k < queue_.size(); ++k) {
      const int node = queue_[k];
      is_reached = is_reached || leads_outside(node);
      for (int a = 0, count = arc_count(node); a < count; ++a)
        if (const int end = end_of_arc(node, a); end >= 0) reach(end, level_[node] + 1);
    }
    return is_reached;
  }

  void reach(int node, int level) {
    if (level_[node] != out_of_reach) return;
    level_[node] = level;
    queue_.push_back(node);
  }

  // Looks for a way from the entry of a vertex to the second side that climbs by a level with every arc, and
  // takes it. A node belongs to one way at most until levels are found anew.
  void augment(int from) {
    if (level_[entry(from)] != 0) return;
    way_ = {entry(from)};
    while (!way_.empty()) {
      const int node = way_.back();
      if (leads_outside(node)) return take();
      const int next = next_node(node);
      if (next >= 0) {
        way_.push_back(next);
      } else {
        level_[node] = tried;
        way_.pop_back();
      }
    }
  }

  int next_node(int node) {
    for (const int count = arc_count(node); arc_[node] < count;) {
      const int end = end_of_arc(node, arc_[node]++);
      if (end >= 0 && level_[end] == level_[node] + 1) return end;
    }
    return -1;
  }

  void take() {
    const auto for_each_arc = [&](const auto& visit) {
      for (std::size_t k = 1; k < way_.size(); ++k)
        if (way_[k - 1] / 2 != way_[k] / 2) visit(way_[k - 1], way_[k]);
    };
    for_each_arc([&](int begin, int end) {
      if (begin == entry(begin / 2)) next_[end / 2] = previous_[begin / 2] = no_vertex;
    });
    for_each_arc([&](int begin, int end) {
      if (begin == exit(begin / 2)) next_[begin / 2] = end / 2, previous_[end / 2] = begin / 2;
    });
    previous_[way_.front() / 2] = next_[way_.back() / 2] = outside;
    for (const int node : way_) level_[node] = tried;
  }

  const Band& band_;
  std::vector<int> next_, previous_;  // the vertices after and before each one on its path
  std::vector<int> level_, arc_;      // of each node; the first arc that has not been tried
  std::vector<int> queue_, way_;
};

}  // namespace

std::vector<PlaceInBand> smallest_separator(const Band& band) {
  const DisjointPaths paths(band);
  std::vector<PlaceInBand> result;
  result.reserve(band.count());
  for (int v = 0; v < band.count(); ++v) result.push_back(paths.place(v));
  return result;
}

}  // namespace orbitutte
