// SPDX-License-Identifier: MIT
// J. W. Suurballe, "Disjoint paths in a network", Networks 4 (1974), with each vertex split into an entry and
// an exit.
#include "orbitutte/cut/paths.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace orbitutte {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

// A priority queue of nodes. No distance in it may exceed the least one by more than the length of an arc.
// Buckets of equal width are reused in a circle (E. Denardo, B. Fox, "Shortest-route methods: 1", Operations
// Research 27 (1979)); the first of them is a heap.
class Queue {
 public:
  using Entry = std::pair<double, int>;  // distance, node

  Queue(double width, double longest_arc)
      : width_(width), buckets_(static_cast<std::size_t>(longest_arc / width) + 2) {}

  void push(const Entry& entry) {
    const std::size_t number = std::max(first_, static_cast<std::size_t>(entry.first / width_));
    std::vector<Entry>& bucket = buckets_[number % buckets_.size()];
    bucket.push_back(entry);
    if (number == first_) std::push_heap(bucket.begin(), bucket.end(), std::greater<>());
    ++size_;
  }

  bool empty() const { return size_ == 0; }

  Entry pop() {
    if (first().empty()) {
      while (first().empty()) ++first_;
      std::make_heap(first().begin(), first().end(), std::greater<>());
    }
    std::pop_heap(first().begin(), first().end(), std::greater<>());
    const Entry entry = first().back();
    first().pop_back();
    --size_;
    return entry;
  }

 private:
  std::vector<Entry>& first() { return buckets_[first_ % buckets_.size()]; }

  double width_;
  std::vector<std::vector<Entry>> buckets_;
  std::size_t first_ = 0, size_ = 0;
};

// Dijkstra's algorithm over nodes 0 .. count - 1.
struct Search {
  std::vector<double> distance;
  std::vector<int> previous;  // -1 at sources and at nodes that are not reached

  explicit Search(int count) : distance(count, infinity), previous(count, -1) {}

  // for_each_arc(node, visit) calls visit(next node, length >= 0). The search ends when done(node) is true
  // for a settled node, and returns that node; otherwise it returns -1.
  template <typename ForEachArc, typename Done>
  int run(const std::vector<int>& sources, Queue queue, const ForEachArc& for_each_arc, const Done& done) {
    for (const int source : sources) {
      distance[source] = 0;
      queue.push({0.0, source});
    }
    while (!queue.empty()) {
      const auto [reached, node] = queue.pop();
      if (reached > distance[node]) continue;
      if (done(node)) return node;
      for_each_arc(node, [&, reached = reached, node = node](int next, double length) {
        const double through = reached + length;
        if (!(through < distance[next])) return;
        distance[next] = through;
        previous[next] = node;
        queue.push({through, next});
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
    if (!graph.dead_end.empty() && graph.dead_end[v]) return;
    for (int k = graph.neighbors.start[v]; k < graph.neighbors.start[v + 1]; ++k)
      visit(graph.neighbors.neighbor[k], graph.length[graph.neighbors.edge[k]]);
  };
}

// A queue for arcs that are up to `factor` times as long as the graph's edges.
Queue queue_for(const EdgeGraph& graph, double factor = 1) {
  const double total = std::accumulate(graph.length.begin(), graph.length.end(), 0.0);
  if (!(total > 0)) return {1, 0};
  const double mean = total / static_cast<double>(graph.length.size());
  const double longest = factor * *std::max_element(graph.length.begin(), graph.length.end());
  return {std::max(mean / 2, longest / 10000), longest};
}

// The residual graph after one unit has gone along `first`. The k-th vertex v of that path has an entry, node
// v, and an exit, node n + k; any other vertex v is one node, v. The potentials reduce the lengths so that
// none is negative.
class Residual {
 public:
  Residual(const EdgeGraph& graph, const Path& first, const std::vector<double>& potential)
      : graph_(graph), first_(first), potential_(potential), place_(graph.vertex_count(), -1) {
    for (std::size_t k = 0; k < first.size(); ++k) place_[first[k]] = static_cast<int>(k);
  }

  int node_count() const { return exit(static_cast<int>(first_.size())); }
  int source() const { return exit(0); }
  int vertex(int node) const { return node < exit(0) ? node : first_[node - exit(0)]; }

  template <typename Visit>
  void operator()(int node, const Visit& visit) const {
    if (node >= exit(0)) {
      const int k = node - exit(0);
      if (k > 0) visit(first_[k], 0.0);  // cancels the passage through the vertex
      const bool last = k + 1 == static_cast<int>(first_.size());
      visit_edges(first_[k], last ? -1 : first_[k + 1], visit);
    } else if (const int k = place_[node]; k < 0) {
      visit_edges(node, -1, visit);
    } else {
      visit(exit(k - 1), 0.0);  // cancels the edge of the first path, whose reduced length is zero
    }
  }

 private:
  int exit(int k) const { return graph_.vertex_count() + k; }

  template <typename Visit>
  void visit_edges(int v, int except, const Visit& visit) const {
    arcs_of(graph_)(v, [&](int next, double length) {
      if (next != first_.front() && next != except)
        visit(next, std::max(0.0, length + potential_[v] - potential_[next]));
    });
  }

  const EdgeGraph& graph_;
  const Path& first_;
  const std::vector<double>& potential_;
  std::vector<int> place_;  // the index on the first path of every vertex; -1 elsewhere
};

// Follows the edges of both paths from the source, without the edges that one path takes forwards and the
// other backwards.
std::array<Path, 2> untangle(const Path& first, const Path& second, const std::array<int, 2>& to) {
  std::unordered_map<int, std::vector<int>> next;
  for (std::size_t k = 1; k < first.size(); ++k) next[first[k - 1]].push_back(first[k]);
  for (std::size_t k = 1; k < second.size(); ++k) {
    const int u = second[k - 1], v = second[k];
    if (u == v) continue;  // from an exit to its entry
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

// A tree that grows by shortest paths: as soon as one is part of it, the search goes on from its vertices,
// too, with the distances that it has found so far (Takahashi, Matsuyama 1980).
class GrowingTree {
 public:
  explicit GrowingTree(const EdgeGraph& graph)
      : graph_(graph), search_(graph.vertex_count()), queue_(queue_for(graph)) {}

  void add(int v) {
    search_.distance[v] = 0;
    search_.previous[v] = -1;
    queue_.push({0.0, v});
  }

  // Adds the path to the nearest vertex that is wanted, and returns it; -1 if none can be reached.
  template <typename IsWanted>
  int reach(const IsWanted& is_wanted) {
    while (!queue_.empty()) {
      const auto [distance, v] = queue_.pop();
      if (distance > search_.distance[v]) continue;
      if (is_wanted(v)) {
        add_path_to(v);
        return v;
      }
      arcs_of(graph_)(v, [&, distance = distance, v = v](int next, double length) {
        if (!(distance + length < search_.distance[next])) return;
        search_.distance[next] = distance + length;
        search_.previous[next] = v;
        queue_.push({distance + length, next});
      });
    }
    return -1;
  }

  std::vector<int> edges() const { return edges_; }

 private:
  void add_path_to(int v) {
    while (v >= 0) {
      const int previous = search_.previous[v];
      if (previous >= 0) edges_.push_back(edge_between(graph_, previous, v));
      add(v);
      v = previous;
    }
  }

  const EdgeGraph& graph_;
  Search search_;
  Queue queue_;
  std::vector<int> edges_;
};

}  // namespace

int edge_between(const EdgeGraph& graph, int v, int w) {
  const Neighbors& near = graph.neighbors;
  int k = near.start[v];
  while (near.neighbor[k] != w) ++k;
  return near.edge[k];
}

std::vector<double> distances(const EdgeGraph& graph, const std::vector<int>& sources) {
  Search search(graph.vertex_count());
  search.run(sources, queue_for(graph), arcs_of(graph), [](int) { return false; });
  return std::move(search.distance);
}

Path shortest_path(const EdgeGraph& graph, int from, const std::vector<int>& to) {
  std::vector<char> is_target(graph.vertex_count(), 0);
  for (const int v : to) is_target[v] = 1;
  Search search(graph.vertex_count());
  const int reached =
      search.run({from}, queue_for(graph), arcs_of(graph), [&](int v) { return is_target[v] != 0; });
  return reached < 0 ? Path() : search.path_to(reached);
}

std::array<Path, 2> disjoint_paths(const EdgeGraph& graph, int from, const std::array<int, 2>& to,
                                   std::vector<double> left) {
  left.resize(graph.vertex_count(), 0.0);
  const auto is_target = [&](int v) { return v == to[0] || v == to[1]; };
  const auto arcs_ahead = [&](int v, const auto& visit) {
    arcs_of(graph)(
        v, [&](int next, double length) { visit(next, std::max(0.0, length - left[v] + left[next])); });
  };
  Search first(graph.vertex_count());
  const int nearest = first.run({from}, queue_for(graph, 2), arcs_ahead, is_target);
  if (nearest < 0) return {};
  const Path path = first.path_to(nearest);
  std::vector<double>& potential = first.distance;
  const double reach = potential[nearest];
  for (int v = 0; v < graph.vertex_count(); ++v) potential[v] = std::min(potential[v], reach) - left[v];

  const int other = nearest == to[0] ? to[1] : to[0];
  const Residual residual(graph, path, potential);
  Search second(residual.node_count());
  const int reached =
      second.run({residual.source()}, queue_for(graph, 4), residual, [&](int node) { return node == other; });
  if (reached < 0) return {};
  Path back = second.path_to(reached);
  for (int& node : back) node = residual.vertex(node);
  return untangle(path, back, to);
}

std::vector<int> tree_edges(const EdgeGraph& graph, const std::vector<int>& roots,
                            const std::vector<int>& to) {
  std::vector<char> is_wanted(graph.vertex_count(), 0);
  for (const int v : to) is_wanted[v] = 1;
  GrowingTree tree(graph);
  for (const int root : roots) tree.add(root);
  for (auto left = std::count(is_wanted.begin(), is_wanted.end(), 1); left > 0; --left) {
    const int reached = tree.reach([&](int v) { return is_wanted[v] != 0; });
    if (reached < 0) return {};
    is_wanted[reached] = 0;
  }
  return tree.edges();
}

}  // namespace orbitutte
