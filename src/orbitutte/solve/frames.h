// SPDX-License-Identifier: MIT
// The frames in which the faces of a cut mesh lie, and how edge flips change them. Private to solve/.
#pragma once

#include <algorithm>
#include <array>
#include <map>
#include <utility>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/dirichlet_energy.h"

namespace orbitutte {

/// An edge of the boundary of a cut mesh: its cut vertices, ascending.
using CutEdge = std::pair<int, int>;
inline CutEdge cut_edge(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

/// The faces in their frames, all of them the cut mesh's before the first flip. Group elements are numbers; 0
/// is the identity. A Table has product(a, b) and inverse(a).
template <typename Table>
class Frames {
 public:
  /// element_of: n_cut, the element that takes an input vertex to the cut vertex.
  Frames(const CutMesh& cut, const std::vector<int>& element_of, Table& elements)
      : elements_(elements), corner_(cut.F.size()), change_(cut.F.size(), 0) {
    parallel_ranges(static_cast<int>(corner_.size()), [&](int begin, int end) {
      for (int h = begin; h < end; ++h) corner_[h] = element_of[copy_at(cut, h)];
    });
  }

  /// The changes of frame at the half-edges along the cut. changes: of every edge of a bank, the element that
  /// takes what lies beyond it, in the cut mesh, to where it continues the face at the edge.
  void open_banks(const Connectivity& connectivity, const CutMesh& cut,
                  const std::map<CutEdge, int>& changes) {
    if (changes.empty()) return;
    std::vector<char> is_on_bank(cut.vertex_count(), 0);
    for (const auto& [edge, change] : changes) is_on_bank[edge.first] = is_on_bank[edge.second] = 1;
    parallel_ranges(static_cast<int>(change_.size()), [&](int begin, int end) {
      for (int h = begin; h < end; ++h) {
        const int from = copy_at(cut, h);
        if (!is_on_bank[from]) continue;  // as almost everywhere
        const int g = connectivity.opposite[h], to = copy_at(cut, next_halfedge(h));
        if (g < 0 || !is_on_bank[to]) continue;
        const int from_there = copy_at(cut, g), to_there = copy_at(cut, next_halfedge(g));
        if (from == to_there && to == from_there) continue;
        const CutEdge here = cut_edge(from, to);
        if (here != cut_edge(from_there, to_there)) change_[h] = changes.at(here);
      }
    });
  }

  /// Takes the second face beside the edge into the frame of the first.
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

  /// Has the vertex where the half-edge ends the element of that where it begins?
  bool is_plain(int h) const { return corner_[h] == corner_[next_halfedge(h)]; }

  /// Seen from where the half-edge begins, the element of the vertex where it ends.
  int along(int h) const {
    return is_plain(h) ? 0 : elements_.product(elements_.inverse(corner_[h]), corner_[next_halfedge(h)]);
  }

 private:
  // The copy in the cut mesh of the vertex where a half-edge of the mesh begins; the cut mesh may have its
  // face turned over.
  static int copy_at(const CutMesh& cut, int h) {
    if (cut.turned.empty()) return halfedge_origin(cut.F, h);
    const int face = h / 3, k = h % 3;
    return cut.F(face, cut.turned[face] != 0 && k > 0 ? 3 - k : k);
  }

  Table& elements_;
  // Of every half-edge: the element of the vertex where it begins.
  std::vector<int> corner_;
  // Of every half-edge: takes the frame of the face beyond it to that of its own.
  std::vector<int> change_;
};

/// The edges of a triangulation, each with its element, by the first of its half-edges. Few edges need the
/// table of elements, which has no locks.
template <typename Table>
std::vector<GluedEdge> edges_along(const Frames<Table>& frames, const Triangles& F,
                                   const Connectivity& connectivity) {
  std::vector<GluedEdge> edges(connectivity.edges.size());
  const std::vector<int> glued = parallel_select(static_cast<int>(connectivity.edge_of.size()), [&](int h) {
    if (connectivity.opposite[h] >= 0 && connectivity.opposite[h] < h) return false;
    edges[connectivity.edge_of[h]] = {halfedge_origin(F, h), halfedge_target(F, h), 0};
    return !frames.is_plain(h);
  });
  for (const int h : glued) edges[connectivity.edge_of[h]].t = frames.along(h);
  return edges;
}

}  // namespace orbitutte
