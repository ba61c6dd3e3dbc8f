// SPDX-License-Identifier: MIT
#include "orbitutte/solve/disk_graph.h"

#include <cmath>
#include <numeric>
#include <unordered_map>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

std::vector<char> given_vertices(const CutMesh& cut, const BoundaryConditions& boundary) {
  std::vector<char> given(boundary.basis_of.size());
  parallel_ranges(static_cast<int>(given.size()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) given[v] = boundary.basis(v).cols() == 0;
  });
  for (const int v : cut.boundary) given[cut.source_vertex[v]] = 1;
  return given;
}

// The edges whose gluing is not the identity.
std::vector<int> edges_across(const GluedEdges& glued) {
  return parallel_select(static_cast<int>(glued.edges.size()), [&](int e) { return glued.edges[e].t != 0; });
}

// The vertices that are on no bank once each edge across the cut has an end on one.
std::vector<char> vertices_inside(const GluedEdges& glued, const std::vector<int>& across,
                                  const std::vector<char>& given) {
  std::vector<char> inside(given.size());
  for (std::size_t v = 0; v < given.size(); ++v) inside[v] = !given[v];
  for (const int e : across) {
    const auto& [i, j, t] = glued.edges[e];
    if (inside[i] && inside[j]) inside[i] = 0;
  }
  return inside;
}

// Puts the neighbours of vertices that are held, cones as a rule, on the banks, unless that makes these much
// longer. Other orders change the weights of none but the edges between them, so that the factor of those
// inside stays.
void put_on_banks_around_held(const GluedEdges& glued, const BoundaryConditions& boundary,
                              std::vector<char>& inside) {
  const double most = std::sqrt(static_cast<double>(inside.size())) / 8;
  const auto is_held = [&](int v) { return boundary.basis(v).cols() == 0; };
  const std::vector<int> at_held = parallel_select(static_cast<int>(glued.edges.size()), [&](int e) {
    return is_held(glued.edges[e].i) || is_held(glued.edges[e].j);
  });
  if (static_cast<double>(at_held.size()) > most) return;
  for (const int e : at_held) inside[glued.edges[e].i] = inside[glued.edges[e].j] = 0;
}

// Numbers the images of vertices in the order in which they are asked for.
class Nodes {
 public:
  explicit Nodes(DiskGraph& graph) : graph_(graph) {}

  int image(int v, int t) {
    if (t == 0) return v;
    const long long key = static_cast<long long>(v) << 32 | t;
    const auto [at, is_new] = known_.emplace(key, graph_.node_count());
    if (is_new) {
      graph_.vertex.push_back(v);
      graph_.transform_of.push_back(t);
    }
    return at->second;
  }

 private:
  DiskGraph& graph_;
  std::unordered_map<long long, int> known_;
};

// The nodes of the banks: along the cut's boundary, then those of the vertices that were added.
std::vector<int> bank_nodes(const CutMesh& cut, const BoundaryConditions& boundary, const DiskGraph& graph) {
  const int n = static_cast<int>(graph.inside.size());
  std::unordered_map<int, std::vector<int>> images;  // not in place
  for (int node = n; node < graph.node_count(); ++node) images[graph.vertex[node]].push_back(node);
  std::vector<char> done = graph.inside;
  std::vector<int> banks;
  const auto add = [&](int v) {
    if (done[v] || boundary.basis(v).cols() == 0) return;
    done[v] = 1;
    banks.push_back(v);
    if (const auto at = images.find(v); at != images.end())
      banks.insert(banks.end(), at->second.begin(), at->second.end());
  };
  for (const int v : cut.boundary) add(cut.source_vertex[v]);
  for (int v = 0; v < n; ++v) add(v);
  return banks;
}

}  // namespace

std::vector<std::array<int, 2>> ends(const GluedEdges& glued) {
  std::vector<std::array<int, 2>> result(glued.edges.size());
  parallel_ranges(static_cast<int>(result.size()), [&](int begin, int end) {
    for (int e = begin; e < end; ++e) result[e] = {glued.edges[e].i, glued.edges[e].j};
  });
  return result;
}

DiskGraph disk_graph(const CutMesh& cut, const GluedEdges& glued, const BoundaryConditions& boundary) {
  DiskGraph graph;
  graph.given = given_vertices(cut, boundary);
  const std::vector<int> across = edges_across(glued);
  graph.inside = vertices_inside(glued, across, graph.given);
  put_on_banks_around_held(glued, boundary, graph.inside);
  graph.transforms = glued.transforms;
  std::vector<int> inverse;
  for (const Isometry& transform : glued.transforms)
    inverse.push_back(index_among(graph.transforms, transform.inverse()));
  graph.vertex.resize(graph.inside.size());
  std::iota(graph.vertex.begin(), graph.vertex.end(), 0);
  graph.transform_of.assign(graph.inside.size(), 0);
  graph.ends = ends(glued);
  Nodes nodes(graph);
  for (const int e : across) {
    const auto& [i, j, t] = glued.edges[e];
    graph.ends[e] = graph.inside[i] || graph.given[j] ? std::array{i, nodes.image(j, t)}
                                                      : std::array{nodes.image(i, inverse[t]), j};
  }
  graph.banks = bank_nodes(cut, boundary, graph);
  return graph;
}

}  // namespace orbitutte
