// SPDX-License-Identifier: MIT
#include "orbitutte/verify/cover.h"

#include <fmt/format.h>

#include <cmath>
#include <utility>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/verify/edge_images.h"
#include "orbitutte/verify/laid_out.h"

namespace orbitutte {
namespace {

int element(const SymmetryGroup& group, const Isometry& isometry) {
  const int g = group.find(isometry);
  if (g < 0) throw ArgumentError("a transform does not belong to the symmetry group");
  return g;
}

// A seam pairs two cut vertices: position(to) = transform * position(from).
struct Passage {
  int to;
  Isometry transform;
};

// The passages from every cut vertex, in both directions of every pair.
std::vector<std::vector<Passage>> passages(const Embedding& embedding) {
  std::vector<std::vector<Passage>> from(embedding.source_vertex.size());
  for (const Seam& seam : embedding.seams) {
    for (std::size_t k = 0; k < seam.left.size(); ++k) {
      from[seam.right[k]].push_back({seam.left[k], seam.transform});
      from[seam.left[k]].push_back({seam.right[k], seam.transform.inverse()});
    }
  }
  return from;
}

// The places of the cut vertices in the cover: cut vertex c is copy lift[c] of its source vertex.
class Lifting {
 public:
  Lifting(const Embedding& embedding, const SymmetryGroup& group)
      : stabilizers(group_vertices(embedding)),
        lift(embedding.source_vertex.size(), unknown),
        group_(group),
        passages_(passages(embedding)) {
    for (int v = 0; v < static_cast<int>(stabilizers.size()); ++v) follow_seams(v);
    for (int c = 0; c < static_cast<int>(lift.size()); ++c)
      if (lift[c] == unknown)
        throw MeshError(
            fmt::format("no seams lead from vertex {} to its copy {}", embedding.source_vertex[c], c));
  }

  std::vector<std::vector<int>> stabilizers;
  std::vector<int> lift;

  // The element lift(from)^-1 lift(to).
  int between(int from, int to) const {
    if (lift[from] == lift[to]) return identity;
    return element(group_, group_.elements()[lift[from]].inverse() * group_.elements()[lift[to]]);
  }

 private:
  static constexpr int unknown = -1, identity = 0;

  // An empty list for every source vertex. The first cut vertices are the source vertices.
  static std::vector<std::vector<int>> group_vertices(const Embedding& embedding) {
    int vertices = 0;
    for (const int source : embedding.source_vertex) vertices = std::max(vertices, source + 1);
    return std::vector<std::vector<int>>(vertices);
  }

  // Searches the copies of v along the seams. Every loop through the seams brings v back to itself by an
  // element of its stabilizer. The loops that the steps of the search close generate it.
  void follow_seams(int v) {
    lift[v] = identity;
    std::vector<int> reached = {v};
    for (std::size_t k = 0; k < reached.size(); ++k) {
      const Isometry& here = group_.elements()[lift[reached[k]]];
      for (const auto& [to, transform] : passages_[reached[k]]) {
        const Isometry there = transform * here;
        if (lift[to] == unknown) {
          lift[to] = element(group_, there);
          reached.push_back(to);
          continue;
        }
        const int loop = element(group_, group_.elements()[lift[to]].inverse() * there);
        if (loop != identity) stabilizers[v].push_back(loop);
      }
    }
  }

  const SymmetryGroup& group_;
  std::vector<std::vector<Passage>> passages_;
};

Eigen::VectorXd vertex_areas(const Embedding& embedding, int vertices) {
  Eigen::VectorXd area = Eigen::VectorXd::Zero(vertices);
  const Points& X = embedding.positions;
  for (int f = 0; f < embedding.triangles.rows(); ++f) {
    const auto v = embedding.triangles.row(f);
    const double third = std::abs(embedding.space().area(X.row(v[0]), X.row(v[1]), X.row(v[2]))) / 3;
    for (int k = 0; k < 3; ++k) area[embedding.source_vertex[v[k]]] += third;
  }
  return area;
}

// The edges in the cover. Each is taken from one of its faces, and its element is lift(origin)^-1
// lift(target).
std::vector<CoverEdge> cover_edges(const Connectivity& connectivity, const EdgeWeights& weights,
                                   const Embedding& embedding, const Lifting& lifting) {
  std::vector<CoverEdge> edges;
  edges.reserve(connectivity.edges.size());
  visit_edges(connectivity, embedding, [&](int e, int from, int to) {
    edges.push_back({embedding.source_vertex[from], embedding.source_vertex[to], lifting.between(from, to),
                     weights.w[e],
                     embedding.space().distance(embedding.positions.row(from), embedding.positions.row(to))});
  });
  return edges;
}

// The element that takes a vertex's position to that of a corner of a face. If several do, they differ by the
// vertex's stabilizer, and any of them will do.
int element_between(const Vector3& position, const Vector3& corner, const SymmetryGroup& group) {
  int nearest = 0;
  double distance = (position - corner).squaredNorm();
  for (int g = 1; g < group.order() && distance > 1e-20; ++g) {
    const double d = (group.elements()[g] * position - corner).squaredNorm();
    if (d < distance) nearest = g, distance = d;
  }
  return nearest;
}

// The edges in the cover for faces whose corners have positions of their own.
std::vector<CoverEdge> layout_edges(const Embedding& layout, const EdgeWeights& weights,
                                    const Points& positions, const SymmetryGroup& group) {
  const std::vector<int>& edge_of = weights.triangulation->connectivity.edge_of;
  std::vector<char> done(weights.w.size(), 0);
  std::vector<CoverEdge> edges;
  for (int h = 0; h < static_cast<int>(edge_of.size()); ++h) {
    if (std::exchange(done[edge_of[h]], 1)) continue;
    const int next = next_halfedge(h), i = layout.source_vertex[h], j = layout.source_vertex[next];
    const Vector3 from = layout.positions.row(h), to = layout.positions.row(next);
    const int at_from = element_between(positions.row(i), from, group),
              at_to = element_between(positions.row(j), to, group);
    const int g =
        at_from == at_to ? 0 : element(group, group.elements()[at_from].inverse() * group.elements()[at_to]);
    edges.push_back({i, j, g, weights.w[edge_of[h]], layout.space().distance(from, to)});
  }
  return edges;
}

Cover cover_of_layout(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
                      const SymmetryGroup& group) {
  Lifting lifting(embedding, group);
  const int vertices = static_cast<int>(lifting.stabilizers.size());
  const Embedding layout = laid_out(surface, embedding, *weights.triangulation);
  const Points positions = embedding.positions.topRows(vertices);
  std::vector<CoverEdge> edges = layout_edges(layout, weights, positions, group);
  return {positions, std::move(lifting.stabilizers), vertex_areas(layout, vertices), std::move(edges)};
}

}  // namespace

Cover cover_of(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding,
               const SymmetryGroup& group) {
  if (weights.triangulation) return cover_of_layout(surface, weights, embedding, group);
  Lifting lifting(embedding, group);
  const int vertices = static_cast<int>(lifting.stabilizers.size());
  std::vector<CoverEdge> edges = cover_edges(surface.connectivity, weights, embedding, lifting);
  return {embedding.positions.topRows(vertices), std::move(lifting.stabilizers),
          vertex_areas(embedding, vertices), std::move(edges)};
}

}  // namespace orbitutte
