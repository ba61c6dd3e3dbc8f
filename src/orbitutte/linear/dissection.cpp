// SPDX-License-Identifier: MIT
#include "orbitutte/linear/dissection.h"

#include <amd.h>
#include <metis.h>

#include <algorithm>
#include <array>
#include <mutex>
#include <new>
#include <numeric>
#include <utility>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int leaf_size = 800;       // sets of at most about so many vertices are not bisected further
constexpr int smoothing_sweeps = 4;  // over the interfaces between the parts

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

// Smooths the interfaces, which clusters leave jagged: moves a vertex to another part if most of its
// neighbours lie there.
void smooth_interfaces(const Neighbors& graph, std::vector<int>& part) {
  std::vector<int> moving, next;
  for (int v = 0; v < vertex_count(graph); ++v) {
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) {
      if (part[graph.neighbor[k]] == part[v]) continue;
      moving.push_back(v);
      break;
    }
  }
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

// The depth of every vertex in the tree: the depth of the bisection that makes it a separator, or `levels` if
// none does.
std::vector<int> depths_of_separation(const Neighbors& graph, const std::vector<int>& part, int levels) {
  const int n = vertex_count(graph);
  std::vector<int> depth(n, levels), near_interface;
  for (int v = 0; v < n; ++v) {
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) {
      if (part[graph.neighbor[k]] == part[v]) continue;
      near_interface.push_back(v);
      break;
    }
  }
  for (int d = 0; d < levels; ++d) {
    const int shift = levels - 1 - d;  // part >> (shift + 1) names the node, the next lower bit its half
    std::vector<int> candidates;
    std::vector<std::array<int, 2>> on_side(std::size_t{1} << d, {0, 0});
    for (const int v : near_interface) {
      if (depth[v] < levels) continue;
      for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) {
        const int u = graph.neighbor[k];
        if (depth[u] < levels || (part[u] ^ part[v]) >> shift != 1) continue;
        candidates.push_back(v);
        ++on_side[part[v] >> (shift + 1)][part[v] >> shift & 1];
        break;
      }
    }
    for (const int v : candidates) {
      const auto& count = on_side[part[v] >> (shift + 1)];
      // The separator comes from the side with fewer vertices.
      if ((part[v] >> shift & 1) == (count[1] < count[0])) depth[v] = d;
    }
  }
  return depth;
}

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
  const std::vector<int> depth = depths_of_separation(graph, part, levels);

  Tree tree = complete_tree(levels);
  std::vector<int> node_of(n);
  for (int v = 0; v < n; ++v) node_of[v] = tree.place[depth[v]][part[v] >> (levels - depth[v])];
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
