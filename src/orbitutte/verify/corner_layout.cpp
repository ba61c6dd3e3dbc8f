// SPDX-License-Identifier: MIT
#include "orbitutte/verify/corner_layout.h"

#include <algorithm>
#include <array>

namespace orbitutte {
namespace {

using Pair = std::array<int, 2>;  // cut vertices, ascending
Pair ascending(int a, int b) { return {std::min(a, b), std::max(a, b)}; }

// The transforms that continue the map beyond the edges of the banks.
std::map<Pair, Isometry> continuations(const std::vector<Seam>& seams) {
  std::map<Pair, Isometry> result;
  for (const Seam& seam : seams) {
    if (seam.is_mirror()) continue;
    for (std::size_t k = 1; k < seam.left.size(); ++k) {
      result[ascending(seam.left[k - 1], seam.left[k])] = seam.transform;
      result[ascending(seam.right[k - 1], seam.right[k])] = seam.transform.inverse();
    }
  }
  return result;
}

}  // namespace

CornerLayout::CornerLayout(const Surface& surface, const Embedding& embedding)
    : F_(surface.triangles), opposite_(surface.connectivity.opposite), positions_(F_.size(), 3) {
  std::vector<int> copy(F_.size());  // of the vertex where each half-edge begins: its cut vertex
  for (int h = 0; h < static_cast<int>(F_.size()); ++h) {
    for (const int v : embedding.triangles.row(h / 3))
      if (embedding.source_vertex[v] == halfedge_origin(F_, h)) copy[h] = v;
    positions_.row(h) = embedding.positions.row(copy[h]);
  }
  take_offsets(embedding, copy);
  const std::map<Pair, Isometry> continuation = continuations(embedding.seams);
  if (continuation.empty()) return;
  for (int h = 0; h < static_cast<int>(F_.size()); ++h) {
    const int g = opposite_[h];
    if (g < 0) continue;
    const Pair here = ascending(copy[h], copy[next_halfedge(h)]);
    if (here != ascending(copy[g], copy[next_halfedge(g)])) beyond_[h] = continuation.at(here);
  }
}

void CornerLayout::take_offsets(const Embedding& embedding, const std::vector<int>& copy) {
  const ExactPositions positions(embedding);
  if (!positions.has_offsets()) return;
  group_ = exact_group(embedding, positions);
  for (int h = 0; h < static_cast<int>(F_.size()); ++h)
    if (positions.has_offsets(copy[h]))
      exact_[h] = {positions.exact(copy[h]), positions.offset_count(copy[h])};
}

CornerLayout::Corner CornerLayout::corner(int h) const {
  const auto at = exact_.find(h);
  return {F_.data()[h], positions_.row(h), at == exact_.end() ? std::nullopt : std::optional(at->second)};
}

// The group is asked for every transform when it is made of others, so that it finds the next.
CornerLayout::Corner CornerLayout::moved(const Isometry& into, Corner corner) const {
  if (into.is_identity()) return corner;
  corner.position = into * corner.position;
  if (!group_) return corner;
  const Matrix3Of<MostPrecise> element = group_->element(into);
  if (corner.exact) corner.exact->position = element * corner.exact->position;
  return corner;
}

void CornerLayout::flip(int h) {
  const int g = opposite_[h], bk = next_halfedge(h), ka = previous_halfedge(h);
  const int lh = previous_halfedge(g);  // begins at l
  const bool turned = halfedge_origin(F_, g) == halfedge_origin(F_, h);
  const int al = turned ? lh : next_halfedge(g), lb = turned ? next_halfedge(g) : lh;
  const Isometry into = beyond(h);
  const Corner a = corner(h), b = corner(bk), k = corner(ka), l = moved(into, corner(lh));
  const std::array<Side, 4> sides = {Side{opposite_[ka], beyond(ka)}, Side{opposite_[al], into * beyond(al)},
                                     Side{opposite_[lb], into * beyond(lb)}, Side{opposite_[bk], beyond(bk)}};
  for (const int s : {1, 2})
    if (sides[s].opposite >= 0) set_beyond(sides[s].opposite, beyond(sides[s].opposite) * into.inverse());
  set_corner(h, l), set_corner(bk, k), set_corner(ka, a);
  set_corner(g, k), set_corner(next_halfedge(g), l), set_corner(previous_halfedge(g), b);
  set_beyond(h, {});
  set_beyond(g, {});
  const std::array<int, 4> places = {next_halfedge(h), previous_halfedge(h), next_halfedge(g),
                                     previous_halfedge(g)};
  for (int s = 0; s < 4; ++s) {
    opposite_[places[s]] = sides[s].opposite;
    if (sides[s].opposite >= 0) opposite_[sides[s].opposite] = places[s];
    set_beyond(places[s], sides[s].beyond);
  }
}

void CornerLayout::set_corner(int h, const Corner& corner) {
  F_.data()[h] = corner.vertex;
  positions_.row(h) = corner.position;
  if (corner.exact) {
    exact_[h] = *corner.exact;
  } else if (!exact_.empty()) {
    exact_.erase(h);
  }
}

Isometry CornerLayout::beyond(int h) const {
  const auto at = beyond_.find(h);
  return at == beyond_.end() ? Isometry() : at->second;
}

void CornerLayout::set_beyond(int h, const Isometry& transform) {
  if (transform.is_identity()) {
    beyond_.erase(h);
  } else {
    beyond_[h] = transform;
    if (group_) group_->element(transform);
  }
}

Embedding embedding_of_corners(const Embedding& like, int triangles,
                               const std::function<CornerLayout::Corner(int)>& corner_at) {
  const int count = 3 * triangles;
  Embedding result;
  result.target = like.target;
  result.placement = like.placement;
  result.positions.resize(count, 3);
  result.triangles.resize(triangles, 3);
  result.source_vertex.resize(count);
  for (int h = 0; h < count; ++h) {
    const CornerLayout::Corner corner = corner_at(h);
    result.triangles.data()[h] = h;
    result.source_vertex[h] = corner.vertex;
    result.positions.row(h) = corner.position;
    if (corner.exact) store(result, h, corner.exact->position, corner.exact->offsets);
  }
  result.cones = like.cones;
  for (ConeCopies& cone : result.cones) {
    cone.copies.clear();
    for (int h = 0; h < count; ++h)
      if (result.source_vertex[h] == cone.vertex) cone.copies.push_back(h);
  }
  return result;
}

}  // namespace orbitutte
