// SPDX-License-Identifier: MIT
#include "orbitutte/solve/stars.h"

#include <numeric>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {
namespace {

// The triangles with a tip. All other vertices of their face are tips too, or its ends.
std::vector<char> flat_triangles(const Triangles& F, int vertex_count, const std::vector<Ear>& ears) {
  std::vector<char> is_flat(F.rows(), 0), is_tip(vertex_count, 0);
  if (ears.empty()) return is_flat;
  for (const Ear& ear : ears) is_tip[ear.tip] = 1;
  for (int h = 0; h < static_cast<int>(F.size()); ++h)
    if (const int v = halfedge_origin(F, h); v < vertex_count && is_tip[v]) is_flat[h / 3] = 1;
  return is_flat;
}

}  // namespace

Stars::Stars(const CutMesh& cut, const BoundaryConditions& boundary, const std::vector<Ear>& ears,
             Elements& elements)
    : cut_(cut),
      boundary_(boundary),
      is_flat_(flat_triangles(cut.F, static_cast<int>(boundary.basis_of.size()), ears)),
      start_(boundary.basis_of.size() + 1, 0) {
  const int halfedges = static_cast<int>(cut.F.size());
  const auto vertex = [&](int h) { return cut.source_vertex[halfedge_origin(cut.F, h)]; };
  for (int h = 0; h < halfedges; ++h)
    if (!is_flat_[h / 3]) ++start_[vertex(h) + 1];
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  halfedges_.resize(start_.back());
  std::vector<int> fill(start_.begin(), start_.end() - 1);
  for (int h = 0; h < halfedges; ++h)
    if (!is_flat_[h / 3]) halfedges_[fill[vertex(h)]++] = h;
  for (int h = 0; h < halfedges; ++h) {
    const int a = halfedge_origin(cut.F, h), b = halfedge_target(cut.F, h);
    for (const auto& [from, to] : {std::pair(a, b), std::pair(b, a)}) {
      const std::pair key(boundary.transform_of[from], boundary.transform_of[to]);
      if (key.first == key.second || element_of_.contains(key)) continue;
      element_of_[key] = elements.index(boundary.transform(from).inverse() * boundary.transform(to));
    }
  }
}

int Stars::element_between(int from, int to) const {
  const std::pair key(boundary_.transform_of[from], boundary_.transform_of[to]);
  return key.first == key.second ? 0 : element_of_.at(key);
}

std::vector<StarTriangle> Stars::around(int vertex) const {
  std::vector<StarTriangle> star;
  star.reserve(static_cast<std::size_t>(start_[vertex + 1] - start_[vertex]));
  for (int k = start_[vertex]; k < start_[vertex + 1]; ++k) {
    const int h = halfedges_[k];
    const int v = halfedge_origin(cut_.F, h);
    int a = halfedge_target(cut_.F, h), b = halfedge_origin(cut_.F, previous_halfedge(h));
    // Seen from the vertex itself, what a rotary reflection has turned over.
    if (boundary_.transform(v).reverses_orientation()) std::swap(a, b);
    star.push_back(
        {h / 3, cut_.source_vertex[a], cut_.source_vertex[b], element_between(v, a), element_between(v, b)});
  }
  return star;
}

std::set<int> Stars::with_neighbours(const std::set<int>& vertices) const {
  std::set<int> result = vertices;
  for (const int v : vertices)
    for (const StarTriangle& triangle : around(v)) result.insert({triangle.a, triangle.b});
  return result;
}

}  // namespace orbitutte
