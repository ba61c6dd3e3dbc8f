// SPDX-License-Identifier: MIT
// J. W. Suurballe, "Disjoint paths in a network", Networks 4 (1974), with the vertices split into an entry
// and an exit.
#include "orbitutte/mesh/paths.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <unordered_map>

namespace orbitutte {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// Dijkstra's algorithm over nodes 0 .. count - 1.
struct Search {
  std::vector<double> distance;
  std::vector<int> previous;  // -1 at sources and where nothing leads

  explicit Search(int count) : distance(count, infinity), previous(count, -1) {}

  // for_each_arc(node, visit) calls visit(next node, length >= 0); the search ends when done(node) says so of
  // a settled node, which is returned, or -1.
  template <typename ForEachArc, typename Done>
  int run(const std::vector<int>& sources, const ForEachArc& for_each_arc, const Done& done) {
    using Entry = std::pair<double, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const int source : sources) {
      distance[source] = 0;
      queue.emplace(0.0, source);
    }
    while (!queue.empty()) {
      const double reached = queue.top().first;
      const int node = queue.top().second;
      queue.pop();
      if (reached > distance[node]) continue;
      if (done(node)) return node;
      for_each_arc(node, [&](int next, double length) {
        const double through = reached + length;
        if (!(through < distance[next])) return;
        distance[next] = through;
        previous[next] = node;
        queue.emplace(through, next);
      });
    }
    return -1;
  }

  Path path_to(int node) const {
    Path path;
    for (; node >= 0; node = previous[node]) path.push_back(node);
    std::reverse(path.begin(), path.end());
    return path;
  }
};

auto arcs_of(const EdgeGraph& graph) {
  return [&graph](int v, const auto& visit) {
    for (int k = graph.neighbors.start[v]; k < graph.neighbors.start[v + 1]; ++k)
      visit(graph.neighbors.neighbor[k], graph.length[graph.neighbors.edge[k]]);
  };
}

// The residual graph after one unit has gone along `first`: node 2 v is the entry of vertex v, 2 v + 1 its
// exit. Lengths are reduced by the potentials, so none is negative.
class Residual {
 public:
  Residual(const EdgeGraph& graph, const Path& first, const std::vector<double>& potential)
      : graph_(graph), potential_(potential), source_(first.front()) {
    for (std::size_t k = 1; k < first.size(); ++k) before_[first[k]] = first[k - 1];
    for (std::size_t k = 0; k + 1 < first.size(); ++k) after_[first[k]] = first[k + 1];
  }

  template <typename Visit>
  void operator()(int node, const Visit& visit) const {
    const int v = node / 2;
    const bool entry = node % 2 == 0;
    const auto before = before_.find(v);
    if (entry && before == before_.end()) {
      visit(2 * v + 1, 0.0);
    } else if (entry) {
      visit(2 * before->second + 1,
            0.0);  // takes back the edge of the first path, whose reduced length is zero
    } else {
      visit_edges(v, visit);
    }
  }

 private:
  template <typename Visit>
  void visit_edges(int v, const Visit& visit) const {
    if (before_.count(v)) visit(2 * v, 0.0);  // takes back the passage through v
    const auto after = after_.find(v);
    arcs_of(graph_)(v, [&](int next, double length) {
      if (next == source_ || (after != after_.end() && after->second == next)) return;
      visit(2 * next, std::max(0.0, length + potential_[v] - potential_[next]));
    });
  }

  const EdgeGraph& graph_;
  const std::vector<double>& potential_;
  int source_;
  std::unordered_map<int, int> before_, after_;  // along the first path
};

// The edges of both paths, those that one takes and the other takes back left out, followed from the source.
std::array<Path, 2> untangle(const Path& first, const Path& second_nodes, const std::array<int, 2>& to) {
  std::unordered_map<int, std::vector<int>> next;
  for (std::size_t k = 1; k < first.size(); ++k) next[first[k - 1]].push_back(first[k]);
  for (std::size_t k = 1; k < second_nodes.size(); ++k) {
    const int u = second_nodes[k - 1] / 2, v = second_nodes[k] / 2;
    if (u == v) continue;
    auto& back = next[v];
    const auto reverse = std::find(back.begin(), back.end(), u);
    if (reverse != back.end()) {
      back.erase(reverse);
    } else {
      next[u].push_back(v);
    }
  }
  std::array<Path, 2> result;
  const int source = first.front();
  for (const int start : next[source]) {
    Path path = {source, start};
    while (path.back() != to[0] && path.back() != to[1]) path.push_back(next[path.back()].front());
    result[path.back() == to[0] ? 0 : 1] = path;
  }
  return result;
}

}  // namespace

std::vector<double> distances(const EdgeGraph& graph, const std::vector<int>& sources) {
  Search search(graph.vertex_count());
  search.run(sources, arcs_of(graph), [](int) { return false; });
  return std::move(search.distance);
}

Path shortest_path(const EdgeGraph& graph, int from, int to) {
  Search search(graph.vertex_count());
  const int reached = search.run({from}, arcs_of(graph), [&](int v) { return v == to; });
  return reached < 0 ? Path() : search.path_to(to);
}

std::array<Path, 2> disjoint_paths(const EdgeGraph& graph, int from, const std::array<int, 2>& to) {
  const auto is_target = [&](int v) { return v == to[0] || v == to[1]; };
  Search first(graph.vertex_count());
  const int nearest = first.run({from}, arcs_of(graph), is_target);
  if (nearest < 0) return {};
  const Path path = first.path_to(nearest);
  std::vector<double>& potential = first.distance;
  const double reach = potential[nearest];
  for (double& p : potential) p = std::min(p, reach);

  const int other = nearest == to[0] ? to[1] : to[0];
  Search second(2 * graph.vertex_count());
  const int reached = second.run({2 * from + 1}, Residual(graph, path, potential),
                                 [&](int node) { return node == 2 * other; });
  if (reached < 0) return {};
  return untangle(path, second.path_to(reached), to);
}

}  // namespace orbitutte
