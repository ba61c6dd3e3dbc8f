// SPDX-License-Identifier: MIT
#include "orbitutte/solve/flipped_edges.h"

#include <map>
#include <utility>

#include "orbitutte/solve/frames.h"

namespace orbitutte {
namespace {

// The elements of a group, each with a number; 0 is the identity.
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

}  // namespace

GluedEdges flipped_edges(const Surface& surface, const IntrinsicTriangulation& triangulation,
                         const CutMesh& cut, const BoundaryConditions& boundary) {
  ElementTable elements(boundary.transforms);
  Frames frames(cut, boundary.transform_of, elements);
  frames.open_banks(surface.connectivity, cut, changes_at_banks(boundary.seams, elements));
  for (const Flip& flip : triangulation.flips) frames.apply(flip);
  std::vector<GluedEdge> edges = edges_along(frames, triangulation.F, triangulation.connectivity);
  return {std::move(edges), elements.release()};
}

}  // namespace orbitutte
