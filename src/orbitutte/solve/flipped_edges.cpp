// SPDX-License-Identifier: MIT
#include "orbitutte/solve/flipped_edges.h"

#include <array>
#include <map>
#include <utility>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// ElementTable of a group, each with a number; 0 is the identity.
class ElementTable {
 public:
  explicit ElementTable(std::vector<Isometry> distinct) : distinct_(std::move(distinct)) {}

  int number(const Isometry& element) { return index_among(distinct_, element); }

  int product(int a, int b) {
    if (a == 0) return b;
    if (b == 0) return a;
    const auto [at, is_new] = products_.try_emplace({a, b}, 0);
    if (is_new) at->second = number(distinct_[a] * distinct_[b]);
    return at->second;
  }

  int inverse(int a) {
    if (a == 0) return 0;
    const auto [at, is_new] = inverses_.try_emplace(a, 0);
    if (is_new) at->second = number(distinct_[a].inverse());
    return at->second;
  }

  std::vector<Isometry> release() { return std::move(distinct_); }

 private:
  std::vector<Isometry> distinct_;
  std::map<std::pair<int, int>, int> products_;
  std::map<int, int> inverses_;
};

using CutEdge = std::pair<int, int>;  // cut vertices, ascending
CutEdge cut_edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// For every edge of a bank the element that takes what lies beyond it, in the cut mesh, to where it
// continues the face at the edge.
std::map<CutEdge, int> changes_at_banks(const std::vector<Seam>& seams, ElementTable& elements) {
  std::map<CutEdge, int> changes;
  for (const Seam& seam : seams) {
    if (seam.left == seam.right) continue;
    const int to_left = elements.number(seam.transform), to_right = elements.inverse(to_left);
    for (std::size_t k = 1; k < seam.left.size(); ++k) {
      changes[cut_edge(seam.left[k - 1], seam.left[k])] = to_left;
      changes[cut_edge(seam.right[k - 1], seam.right[k])] = to_right;
    }
  }
  return changes;
}

// The faces in their frames, all of them the cut mesh's before the first flip.
class Frames {
 public:
  Frames(const CutMesh& cut, const BoundaryConditions& boundary, ElementTable& elements)
      : elements_(elements), corner_(cut.F.size()), change_(cut.F.size(), 0) {
    parallel_ranges(static_cast<int>(corner_.size()), [&](int begin, int end) {
      for (int h = begin; h < end; ++h) corner_[h] = boundary.transform_of[copy_at(cut, h)];
    });
  }

  // The changes of frame at the half-edges along the cut.
  void open_banks(const Connectivity& connectivity, const CutMesh& cut,
                  const std::map<CutEdge, int>& changes) {
    if (changes.empty()) return;
    parallel_ranges(static_cast<int>(change_.size()), [&](int begin, int end) {
      for (int h = begin; h < end; ++h) {
        const int g = connectivity.opposite[h];
        if (g < 0) continue;
        const CutEdge here = cut_edge(copy_at(cut, h), copy_at(cut, next_halfedge(h))),
                      there = cut_edge(copy_at(cut, g), copy_at(cut, next_halfedge(g)));
        if (here != there) change_[h] = changes.at(here);
      }
    });
  }

  void apply(const Flip& flip) {
    const int h = flip.h, g = flip.g, bk = next_halfedge(h), ka = previous_halfedge(h);
    const int into = change_[h], a = corner_[h], b = corner_[bk], k = corner_[ka],
              l = elements_.product(into, corner_[previous_halfedge(g)]);
    const std::array<int, 4> changes = {change_[ka], elements_.product(into, change_[flip.al]),
                                        elements_.product(into, change_[flip.lb]), change_[bk]};
    for (const int beyond : {flip.beyond_al, flip.beyond_lb})
      if (beyond >= 0) change_[beyond] = elements_.product(change_[beyond], elements_.inverse(into));
    const int ka_now = next_halfedge(h), al_now = previous_halfedge(h), lb_now = next_halfedge(g),
              bk_now = previous_halfedge(g);
    corner_[h] = l, corner_[ka_now] = k, corner_[al_now] = a;
    corner_[g] = k, corner_[lb_now] = l, corner_[bk_now] = b;
    change_[h] = change_[g] = 0;
    change_[ka_now] = changes[0], change_[al_now] = changes[1];
    change_[lb_now] = changes[2], change_[bk_now] = changes[3];
  }

  // Has the vertex where the half-edge ends the transform of that where it begins?
  bool is_plain(int h) const { return corner_[h] == corner_[next_halfedge(h)]; }

  // Seen from where the half-edge begins, the transform of the vertex where it ends.
  int along(int h) const {
    return is_plain(h) ? 0 : elements_.product(elements_.inverse(corner_[h]), corner_[next_halfedge(h)]);
  }

 private:
  // The copy in the cut mesh of the vertex where a half-edge of the mesh begins; the cut mesh may have its
  // face turned over.
  static int copy_at(const CutMesh& cut, int h) {
    const int face = h / 3, k = h % 3;
    const bool is_turned = !cut.turned.empty() && cut.turned[face] != 0;
    return cut.F(face, is_turned && k > 0 ? 3 - k : k);
  }

  ElementTable& elements_;
  std::vector<int> corner_;  // of every half-edge: the transform of the vertex where it begins
  std::vector<int> change_;  // of every half-edge: takes the frame of the face beyond it to that of its own
};

}  // namespace

GluedEdges flipped_edges(const Surface& surface, const IntrinsicTriangulation& triangulation,
                         const CutMesh& cut, const BoundaryConditions& boundary) {
  ElementTable elements(boundary.transforms);
  Frames frames(cut, boundary, elements);
  frames.open_banks(surface.connectivity, cut, changes_at_banks(boundary.seams, elements));
  for (const Flip& flip : triangulation.flips) frames.apply(flip);

  GluedEdges result;
  const auto& [edges, edge_of, opposite] = triangulation.connectivity;
  result.edges.resize(edges.size());
  // Each edge by the first of its half-edges. Few edges need the table of elements, which has no locks.
  const std::vector<int> glued = parallel_select(static_cast<int>(edge_of.size()), [&, &edge_of = edge_of,
                                                                                    &opposite =
                                                                                        opposite](int h) {
    if (opposite[h] >= 0 && opposite[h] < h) return false;
    result.edges[edge_of[h]] = {halfedge_origin(triangulation.F, h), halfedge_target(triangulation.F, h), 0};
    return !frames.is_plain(h);
  });
  for (const int h : glued) result.edges[edge_of[h]].t = frames.along(h);
  result.transforms = elements.release();
  return result;
}

}  // namespace orbitutte
