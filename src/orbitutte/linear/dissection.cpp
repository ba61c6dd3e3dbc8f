// SPDX-License-Identifier: MIT
#include "orbitutte/linear/dissection.h"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <bit>
#include <mutex>
#include <new>
#include <numeric>
#include <utility>

#include "orbitutte/linear/smallest_separator.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int leaf_size = 800;       // sets of at most about so many vertices are not bisected further
constexpr int smoothing_sweeps = 4;  // over the interfaces between the parts
constexpr int band_layers = 2;       // of vertices on either side of an interface
constexpr int parallel_depths = 6;   // below, both halves of a set are separated on one thread

int vertex_count(const Neighbors& graph) { return static_cast<int>(graph.start.size()) - 1; }

struct Clusters {
  std::vector<int> of;  // the cluster of every vertex
  int count = 0;
};

// Makes a cluster of a vertex and its neighbours if none of them belongs to one yet. Vertices left over join
// a neighbouring cluster.
Clusters clustered(const Neighbors& graph) {
  const int n = vertex_count(graph);
  Clusters clusters = {std::vector<int>(n, -1)};
  std::vector<int>& of = clusters.of;
  const auto around = [&](int v, const auto& visit) {
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) visit(graph.neighbor[k]);
  };
  for (int v = 0; v < n; ++v) {
    bool free = of[v] < 0;
    around(v, [&](int u) { free = free && of[u] < 0; });
    if (!free) continue;
    of[v] = clusters.count;
    around(v, [&](int u) { of[u] = clusters.count; });
    ++clusters.count;
  }
  const std::vector<int> taken = of;
  for (int v = 0; v < n; ++v) {
    around(v, [&](int u) {
      if (of[v] < 0) of[v] = taken[u];
    });
  }
  return clusters;
}

// The graph of the clusters. Its weights count the vertices of a cluster and the edges between two.
struct ClusterGraph {
  std::vector<idx_t> start = {0}, neighbor, vertex_weight, edge_weight;
};

ClusterGraph graph_of(const Clusters& clusters, const Neighbors& graph) {
  const int n = vertex_count(graph);
  std::vector<int> first(clusters.count + 1, 0), members(n);
  for (const int c : clusters.of) ++first[c + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
  std::vector<int> fill(first.begin(), first.end() - 1);
  for (int v = 0; v < n; ++v) members[fill[clusters.of[v]]++] = v;

  ClusterGraph result;
  // The place of each cluster in result.neighbor; valid if it is not before the current cluster's begin.
  std::vector<int> place(clusters.count, -1);
  for (int c = 0; c < clusters.count; ++c) {
    const int begin = static_cast<int>(result.neighbor.size());
    for (int m = first[c]; m < first[c + 1]; ++m) {
      for (int k = graph.start[members[m]]; k < graph.start[members[m] + 1]; ++k) {
        const int d = clusters.of[graph.neighbor[k]];
        if (d == c) continue;
        if (place[d] < begin) {
          place[d] = static_cast<int>(result.neighbor.size());
          result.neighbor.push_back(d);
          result.edge_weight.push_back(0);
        }
        ++result.edge_weight[place[d]];
      }
    }
    result.start.push_back(static_cast<idx_t>(result.neighbor.size()));
    result.vertex_weight.push_back(first[c + 1] - first[c]);
  }
  return result;
}

// The side of every vertex, 0 or 1, of about the same weight, in the order in which they come.
std::vector<idx_t> halves_of_sequence(const ClusterGraph& graph) {
  const idx_t total = std::accumulate(graph.vertex_weight.begin(), graph.vertex_weight.end(), idx_t{0});
  std::vector<idx_t> half;
  idx_t before = 0;
  for (const idx_t weight : graph.vertex_weight) {
    half.push_back(2 * before + weight > total ? 1 : 0);
    before += weight;
  }
  return half;
}

// The same, with few edges between the sides.
std::vector<idx_t> halves(ClusterGraph& graph) {
  if (graph.neighbor.empty()) return halves_of_sequence(graph);
  idx_t count = static_cast<idx_t>(graph.vertex_weight.size()), constraints = 1, parts = 2, cut = 0;
  std::vector<idx_t> half(count, 0);
  idx_t options[METIS_NOPTIONS];
  METIS_SetDefaultOptions(options);
  options[METIS_OPTION_SEED] = 0;
  // METIS takes its random numbers from rand(), which it seeds once for each call: two calls at a time would
  // take them from each other, and no result would be the same twice.
  static std::mutex one_at_a_time;
  const std::lock_guard lock(one_at_a_time);
  const int status = METIS_PartGraphRecursive(&count, &constraints, graph.start.data(), graph.neighbor.data(),
                                              graph.vertex_weight.data(), nullptr, graph.edge_weight.data(),
                                              &parts, nullptr, nullptr, options, &cut, half.data());
  if (status == METIS_ERROR_MEMORY) throw std::bad_alloc();
  if (status != METIS_OK) throw Error("METIS could not partition the mesh");
  return half;
}

// A graph, and the clusters that its vertices are.
struct Portion {
  ClusterGraph graph;
  std::vector<int> cluster;
};

// The vertices of one side, and the edges between them.
Portion portion_of(const Portion& whole, const std::vector<idx_t>& half, idx_t side) {
  std::vector<idx_t> number(half.size(), -1);
  Portion result;
  for (std::size_t v = 0; v < half.size(); ++v) {
    if (half[v] != side) continue;
    number[v] = static_cast<idx_t>(result.cluster.size());
    result.cluster.push_back(whole.cluster[v]);
    result.graph.vertex_weight.push_back(whole.graph.vertex_weight[v]);
  }
  for (std::size_t v = 0; v < half.size(); ++v) {
    if (half[v] != side) continue;
    for (idx_t k = whole.graph.start[v]; k < whole.graph.start[v + 1]; ++k) {
      if (number[whole.graph.neighbor[k]] < 0) continue;
      result.graph.neighbor.push_back(number[whole.graph.neighbor[k]]);
      result.graph.edge_weight.push_back(whole.graph.edge_weight[k]);
    }
    result.graph.start.push_back(static_cast<idx_t>(result.graph.neighbor.size()));
  }
  return result;
}

// Appends a bit for every level to the part of each cluster of the portion. METIS would do the recursion
// itself, but it prints to standard output if one of its parts is left without vertices, as where a cluster
// holds most of the mesh.
void bisect(Portion portion, int levels, std::vector<int>& part) {
  if (levels == 0 || portion.cluster.empty()) return;
  const std::vector<idx_t> half = halves(portion.graph);
  for (std::size_t v = 0; v < half.size(); ++v)
    part[portion.cluster[v]] += static_cast<int>(half[v]) << (levels - 1);
  Portion left = portion_of(portion, half, 0), right = portion_of(portion, half, 1);
  portion = {};
  bisect(std::move(left), levels - 1, part);
  bisect(std::move(right), levels - 1, part);
}

// The part of every cluster by recursive bisection: the highest bit of its number is the first bisection's,
// and so on.
std::vector<int> bisected(ClusterGraph graph, int levels) {
  const int count = static_cast<int>(graph.vertex_weight.size());
  std::vector<int> part(count, 0), all(count);
  std::iota(all.begin(), all.end(), 0);
  bisect({std::move(graph), std::move(all)}, levels, part);
  return part;
}

// Calls visit(u) for every neighbour of v.
template <typename Visit>
void for_neighbors(const Neighbors& graph, int v, const Visit& visit) {
  for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) visit(graph.neighbor[k]);
}

std::vector<int> vertices_at_interfaces(const Neighbors& graph, const std::vector<int>& part) {
  return parallel_select(vertex_count(graph), [&](int v) {
    bool is_at_one = false;
    for_neighbors(graph, v, [&](int u) { is_at_one = is_at_one || part[u] != part[v]; });
    return is_at_one;
  });
}

// Smooths the interfaces, which clusters leave jagged: moves a vertex to another part if most of its
// neighbours lie there.
void smooth_interfaces(const Neighbors& graph, std::vector<int>& part) {
  const std::vector<int> moving = vertices_at_interfaces(graph, part);
  for (int sweep = 0; sweep < smoothing_sweeps; ++sweep) {
    for (const int v : moving) {
      const auto begin = graph.neighbor.begin() + graph.start[v],
                 end = graph.neighbor.begin() + graph.start[v + 1];
      const auto neighbors_in = [&](int p) {
        return std::count_if(begin, end, [&](int u) { return part[u] == p; });
      };
      int best = part[v];
      auto most = neighbors_in(best);
      for (auto u = begin; u != end; ++u) {
        if (part[*u] == best) continue;
        if (const auto here = neighbors_in(part[*u]); here > most) most = here, best = part[*u];
      }
      part[v] = best;
    }
  }
}

// Finds the separators of a tree of bisections, each the smallest in a band along the interface of its two
// sides. Vertices of the band may change sides on the way; they join parts of their new neighbours.
class BandSeparators {
 public:
  // The part of a vertex is the path to its leaf: the highest of `levels` bits is the first bisection's.
  BandSeparators(const Neighbors& graph, const std::vector<int>& part, int levels)
      : graph_(graph), levels_(levels), spots_(part.size()), size_(std::size_t{1} << levels, 0) {
    parallel_ranges(static_cast<int>(part.size()), [&](int begin, int end) {
      for (int v = begin; v < end; ++v) spots_[v] = {part[v], levels, -1};
    });
    for (const int p : part) ++size_[p];
    std::vector<Near> near;
    for (const int v : vertices_at_interfaces(graph, part)) note(v, near);
    separate({0, 0}, std::move(near));
  }

  // The vertex's place in the tree: the depth of the bisection that makes it a separator, or the number of
  // levels if none does, and the path to there.
  int depth(int v) const { return spots_[v].depth; }
  int path(int v) const { return spots_[v].part >> (levels_ - depth(v)); }

 private:
  struct Spot {
    int part, depth;
    int in_band;  // the vertex's index there; -1 elsewhere
  };
  struct Node {
    int depth, path;
  };
  // A vertex that belongs to no separator yet, and the first bisection of which it is at an interface.
  struct Near {
    int vertex, depth;
  };
  // The vertices of a band, how many edges each is away from the interface, and the most on either side.
  struct Strip {
    std::vector<int> vertex, layer;
    std::array<int, 2> last = {0, 0};
  };

  bool is_free(int v) const { return spots_[v].depth == levels_; }
  int side(int v, int depth) const { return spots_[v].part >> (levels_ - 1 - depth) & 1; }

  // Appends the vertex to `near` if it is at an interface.
  void note(int v, std::vector<Near>& near) const {
    unsigned differing = 0;
    for_neighbors(graph_, v, [&](int u) {
      if (is_free(u)) differing = std::max(differing, unsigned(spots_[u].part ^ spots_[v].part));
    });
    if (differing != 0) near.push_back({v, levels_ - static_cast<int>(std::bit_width(differing))});
  }

  void separate(Node node, std::vector<Near> near) {
    if (node.depth == levels_) return;
    std::array<std::vector<Near>, 2> below = halve(node, near);
    near = {};
    const auto go_on = [&](int half) {
      separate({node.depth + 1, 2 * node.path + half}, std::move(below[half]));
    };
    if (node.depth < parallel_depths) {
      parallel_for(2, go_on);
    } else {
      for (const int half : {0, 1}) go_on(half);
    }
  }

  // Takes the separator of the node's halves. Returns what is near interfaces of either.
  std::array<std::vector<Near>, 2> halve(Node node, const std::vector<Near>& near) {
    const Strip strip = strip_along(node, near);
    const int larger = larger_half(node);
    const std::vector<PlaceInBand> place = smallest_separator(band_of(strip, node.depth, larger));
    std::vector<int> crossing;  // vertices of the strip that change sides
    for (std::size_t k = 0; k < place.size(); ++k) {
      const int v = strip.vertex[k];
      spots_[v].in_band = -1;
      if (place[k] == PlaceInBand::within) {
        --size_[spots_[v].part];
        spots_[v].depth = node.depth;
      } else if ((side(v, node.depth) == larger) != (place[k] == PlaceInBand::before)) {
        crossing.push_back(v);
      }
    }
    cross(node.depth, crossing);

    std::array<std::vector<Near>, 2> below;
    const auto note_again = [&](int v) {
      if (is_free(v)) note(v, below[side(v, node.depth)]);
    };
    for (const Near& n : near) {
      if (n.depth == node.depth) {
        note_again(n.vertex);
      } else if (is_free(n.vertex)) {
        below[side(n.vertex, node.depth)].push_back(n);
      }
    }
    for (const int v : with_neighbors(std::move(crossing))) note_again(v);
    return below;
  }

  // Each once.
  std::vector<int> with_neighbors(std::vector<int> vertices) const {
    for (std::size_t k = 0, count = vertices.size(); k < count; ++k)
      for_neighbors(graph_, vertices[k], [&](int u) { vertices.push_back(u); });
    std::sort(vertices.begin(), vertices.end());
    vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
    return vertices;
  }

  Strip strip_along(Node node, const std::vector<Near>& near) {
    Strip strip;
    const auto add = [&](int v, int layer) {
      if (!is_free(v) || spots_[v].in_band >= 0) return;
      spots_[v].in_band = static_cast<int>(strip.vertex.size());
      strip.vertex.push_back(v);
      strip.layer.push_back(layer);
      strip.last[side(v, node.depth)] = layer;
    };
    for (const Near& n : near)
      if (n.depth == node.depth) add(n.vertex, 0);
    for (std::size_t k = 0; k < strip.vertex.size(); ++k)
      if (const int next = strip.layer[k] + 1; next < band_layers)
        for_neighbors(graph_, strip.vertex[k], [&](int u) { add(u, next); });
    return strip;
  }

  int larger_half(Node node) const {
    std::array<long, 2> size = {0, 0};
    const int parts = 1 << (levels_ - node.depth);
    for (int p = node.path * parts; p < (node.path + 1) * parts; ++p)
      size[p >> (levels_ - 1 - node.depth) & 1] += size_[p];
    return size[1] > size[0] ? 1 : 0;
  }

  Band band_of(const Strip& strip, int depth, int first_side) const {
    Band band;
    band.start = {0};
    band.start.reserve(strip.vertex.size() + 1);
    for (std::size_t k = 0; k < strip.vertex.size(); ++k) {
      const int v = strip.vertex[k], half = side(v, depth);
      const bool is_at_end = strip.layer[k] == strip.last[half];
      band.first.push_back(is_at_end && half == first_side ? 1 : 0);
      band.second.push_back(is_at_end && half != first_side ? 1 : 0);
      for_neighbors(graph_, v, [&](int u) {
        if (is_free(u) && spots_[u].in_band >= 0) band.neighbor.push_back(spots_[u].in_band);
      });
      band.start.push_back(static_cast<int>(band.neighbor.size()));
    }
    return band;
  }

  // Gives vertices that change sides the part of a neighbour there; those that have none that of the same
  // path from the next bisection on.
  void cross(int depth, const std::vector<int>& crossing) {
    std::vector<int> waiting = crossing, later;
    const int bit = 1 << (levels_ - 1 - depth);
    while (!waiting.empty()) {
      for (const int v : waiting) {
        int part = -1;
        for_neighbors(graph_, v, [&](int u) {
          if (part < 0 && is_free(u) && side(u, depth) != side(v, depth)) part = spots_[u].part;
        });
        if (part < 0) {
          later.push_back(v);
        } else {
          move(v, part);
        }
      }
      if (later.size() == waiting.size()) break;
      waiting = std::exchange(later, {});
    }
    for (const int v : later) move(v, spots_[v].part ^ bit);
  }

  void move(int v, int part) {
    --size_[spots_[v].part];
    ++size_[part];
    spots_[v].part = part;
  }

  const Neighbors& graph_;
  int levels_;
  std::vector<Spot> spots_;
  std::vector<int> size_;  // of each part
};

// The complete binary tree with `levels` levels below its root, without vertices yet. `place` holds the index
// of node (depth, path).
struct Tree {
  std::vector<Dissection::Node> nodes;
  std::vector<std::vector<int>> place;  // [depth][path]
};

int add_subtree(Tree& tree, int depth, int path, int levels) {
  int left = -1, right = -1;
  if (depth < levels) {
    left = add_subtree(tree, depth + 1, 2 * path, levels);
    right = add_subtree(tree, depth + 1, 2 * path + 1, levels);
  }
  const int node = static_cast<int>(tree.nodes.size());
  tree.nodes.push_back({-1, depth});
  if (left >= 0) tree.nodes[left].parent = tree.nodes[right].parent = node;
  tree.place[depth][path] = node;
  return node;
}

Tree complete_tree(int levels) {
  Tree tree;
  for (int d = 0; d <= levels; ++d) tree.place.emplace_back(std::size_t{1} << d);
  add_subtree(tree, 0, 0, levels);
  return tree;
}

// Orders one set of vertices, order[begin .. end - 1], by approximate minimum degree. `place` holds the
// position of each vertex in `order`.
void order_set(const Neighbors& graph, const std::vector<int>& place, const Dissection::Node& node,
               std::vector<int>& order) {
  const int count = node.end - node.begin;
  if (count < 2) return;
  const std::vector<int> set(order.begin() + node.begin, order.begin() + node.end);
  std::vector<int> start = {0}, row, eliminated(count);
  for (const int v : set) {
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k)
      if (const int at = place[graph.neighbor[k]]; at >= node.begin && at < node.end)
        row.push_back(at - node.begin);
    start.push_back(static_cast<int>(row.size()));
  }
  row.push_back(0);  // AMD needs a first element
  if (amd_order(count, start.data(), row.data(), eliminated.data(), nullptr, nullptr) < AMD_OK)
    throw std::bad_alloc();
  for (int k = 0; k < count; ++k) order[node.begin + k] = set[eliminated[k]];
}

// The root of the smallest subtree that holds both nodes.
int common_root(const std::vector<Dissection::Node>& nodes, int a, int b) {
  while (a != b) {
    int& deeper = nodes[a].depth >= nodes[b].depth ? a : b;
    deeper = nodes[deeper].parent;
  }
  return a;
}

// The node of every vertex.
std::vector<int> nodes_of_vertices(const Dissection& dissection) {
  std::vector<int> node_of(dissection.order.size());
  parallel_for(static_cast<int>(dissection.nodes.size()), [&](int k) {
    for (int at = dissection.nodes[k].begin; at < dissection.nodes[k].end; ++at)
      node_of[dissection.order[at]] = k;
  });
  return node_of;
}

// Gives the nodes their places in the order, one after the other, from the numbers of their vertices, which
// are in `end`.
void place_nodes(std::vector<Dissection::Node>& nodes) {
  int end = 0;
  for (Dissection::Node& node : nodes) {
    node.begin = node.first = end;
    end = node.end += end;
  }
  for (const Dissection::Node& node : nodes)
    if (node.parent >= 0) nodes[node.parent].first = std::min(nodes[node.parent].first, node.first);
}

}  // namespace

Dissection dissect(const Neighbors& graph) {
  const int n = vertex_count(graph);
  int levels = 0;
  while (n >> levels >= 2 * leaf_size) ++levels;
  std::vector<int> part(n, 0);
  if (levels > 0) {
    const Clusters clusters = clustered(graph);
    const std::vector<int> part_of_cluster = bisected(graph_of(clusters, graph), levels);
    for (int v = 0; v < n; ++v) part[v] = part_of_cluster[clusters.of[v]];
    smooth_interfaces(graph, part);
  }
  const BandSeparators separators(graph, part, levels);

  Tree tree = complete_tree(levels);
  std::vector<int> node_of(n);
  for (int v = 0; v < n; ++v) node_of[v] = tree.place[separators.depth(v)][separators.path(v)];
  Dissection result = {std::vector<int>(n), std::move(tree.nodes)};
  for (const int node : node_of) ++result.nodes[node].end;
  place_nodes(result.nodes);
  std::vector<int> fill, place(n);
  for (const Dissection::Node& node : result.nodes) fill.push_back(node.begin);
  for (int v = 0; v < n; ++v) result.order[place[v] = fill[node_of[v]]++] = v;
  parallel_for(static_cast<int>(result.nodes.size()),
               [&](int k) { order_set(graph, place, result.nodes[k], result.order); });
  return result;
}

Dissection adapted(Dissection dissection, const std::vector<std::array<int, 2>>& edges) {
  std::vector<Dissection::Node>& nodes = dissection.nodes;
  std::vector<int> node_of = nodes_of_vertices(dissection);
  const auto separator = [&](int e) {
    return common_root(nodes, node_of[edges[e][0]], node_of[edges[e][1]]);
  };
  const std::vector<int> joining = parallel_select(static_cast<int>(edges.size()), [&](int e) {
    const int a = node_of[edges[e][0]], b = node_of[edges[e][1]];
    return a != b && separator(e) != std::max(a, b);
  });
  if (joining.empty()) return dissection;
  std::vector<char> moves(node_of.size(), 0);
  for (const int e : joining) {
    const int v = edges[e][0], above = separator(e);
    if (above == node_of[v] || above == node_of[edges[e][1]]) continue;
    node_of[v] = above;
    moves[v] = 1;
  }
  for (Dissection::Node& node : nodes) node.end = 0;
  for (const int node : node_of) ++nodes[node].end;
  place_nodes(nodes);
  std::vector<int> fill, before = std::move(dissection.order);
  for (const Dissection::Node& node : nodes) fill.push_back(node.begin);
  dissection.order.resize(before.size());
  // Those that move come last in their new sets.
  std::stable_partition(before.begin(), before.end(), [&](int v) { return moves[v] == 0; });
  for (const int v : before) dissection.order[fill[node_of[v]]++] = v;
  return dissection;
}

}  // namespace orbitutte
