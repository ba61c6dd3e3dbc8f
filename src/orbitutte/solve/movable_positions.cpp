// SPDX-License-Identifier: MIT
#include "orbitutte/solve/movable_positions.h"

#include <algorithm>
#include <limits>

#include "orbitutte/geometry/orientation.h"
#include "orbitutte/geometry/precise_distance.h"

namespace orbitutte {
namespace {

template <typename Real>
Vector3Of<Real> to_precise(const Vector3& p) {
  return p.cast<Real>();
}

// The marks are where input vertices are held.
template <typename Real>
PreciseGroup<Real> group_of(const Gluing& gluing, const Target& target) {
  const CutMesh& cut = gluing.cut;
  const BoundaryConditions& boundary = gluing.boundary;
  const auto position = [&](int v) {
    const int source = cut.source_vertex[v];
    return to_precise<Real>(boundary.transform(v) * boundary.held_at(source));
  };
  return group_of_boundary<Real>(target,
                                 {cut.boundary, cut.source_vertex, boundary.seams, boundary.cones, position});
}

}  // namespace

Vector3 MovablePositions::difference(int v, int u, int element) const {
  const Vector3 there = positions_.row(u), here = positions_.row(v);
  return (element == 0 ? there : gluing_.elements[element] * there) - here;
}

Vector3 MovablePositions::pull(int v, const std::vector<Neighbour>& neighbours,
                               const std::vector<double>& factors) const {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < neighbours.size(); ++k)
    sum += factors[k] * difference(v, neighbours[k].vertex, neighbours[k].element);
  return gluing_.boundary.space.tangent(positions_.row(v), sum);
}

Vector3 MovablePositions::harmonic_pull(int v, const std::vector<Neighbour>& neighbours, double) const {
  const Space space = gluing_.boundary.space;
  std::vector<double> factors;
  factors.reserve(neighbours.size());
  visit_curvature(space, [&]<int k>(Curvature<k>) {
    for (const Neighbour& at : neighbours) {
      const Vector3 away = difference(v, at.vertex, at.element);
      factors.push_back(at.weight * Curvature<k>::over_sn(space.dot(away, away)));
    }
  });
  return pull(v, neighbours, factors);
}

void MovablePositions::move(int v, const Vector3& step) {
  remember(v);
  positions_.row(v) = gluing_.boundary.feasible(v, positions_.row(v).transpose() + step);
}

void MovablePositions::put(int v, int u, int element, const Vector3& step) {
  move(v, difference(v, u, element) + step);
}

void MovablePositions::shift(int v, const Vector3& step) {
  remember(v);
  positions_.row(v) += step;
}

// The corners as they are spread over the cut mesh.
bool MovablePositions::is_positive(int face) const {
  const auto corner = [&](int k) -> Vector3 {
    const int v = gluing_.cut.F(face, k), source = gluing_.cut.source_vertex[v];
    const Vector3 p = positions_.row(source);
    return v == source ? p : gluing_.boundary.transform(v) * p;
  };
  return is_visibly_positive(corner(0), corner(1), corner(2));
}

void MovablePositions::take_back(std::size_t moves) {
  for (; journal_.size() > moves; journal_.pop_back())
    positions_.row(journal_.back().first) = journal_.back().second;
}

template <typename Real>
PrecisePositions<Real>::PrecisePositions(Gluing gluing, Points& positions, const Target& target)
    : MovablePositions(gluing, positions),
      group_(group_of<Real>(gluing, target)),
      slot_(positions.rows(), -1) {
  const BoundaryConditions& boundary = gluing.boundary;
  for (const Isometry& transform : boundary.transforms) transforms_.push_back(group_.element(transform));
  for (const Isometry& mirror : boundary.mirrors) mirrors_.push_back(group_.element(mirror));
}

template <typename Real>
typename PrecisePositions<Real>::Vector PrecisePositions<Real>::precise(int v) const {
  return is_refined(v) ? digits_[slot_[v]] : to_precise<Real>(rounded(v));
}

// In the order in which they were made, each from some before it: so the group finds them.
template <typename Real>
const typename PrecisePositions<Real>::Matrix& PrecisePositions<Real>::element(int k) const {
  while (static_cast<int>(elements_.size()) <= k)
    elements_.push_back(group_.element(gluing().elements[static_cast<int>(elements_.size())]));
  return elements_[k];
}

template <typename Real>
Vector3 PrecisePositions<Real>::difference(int v, int u, int k) const {
  if (!is_refined(v) && !is_refined(u)) return MovablePositions::difference(v, u, k);
  const Vector there = k == 0 ? precise(u) : Vector(element(k) * precise(u));
  return Vector(there - precise(v)).template cast<double>();
}

template <typename Real>
Vector3 PrecisePositions<Real>::pull(int v, const std::vector<Neighbour>& neighbours,
                                     const std::vector<double>& factors) const {
  const Vector here = precise(v);
  Vector sum = Vector::Zero();
  for (std::size_t k = 0; k < neighbours.size(); ++k) {
    const auto& [u, e, weight] = neighbours[k];
    const Vector there = e == 0 ? precise(u) : Vector(element(e) * precise(u));
    sum += Real(factors[k]) * Vector(there - here);
  }
  return tangential(here, sum);
}

// See Curvature::tangent.
template <typename Real>
Vector3 PrecisePositions<Real>::tangential(const Vector& here, const Vector& sum) const {
  const Real off = gluing().boundary.space.form(here, sum);
  return Vector(sum - off * here).template cast<double>();
}

template <typename Real>
Vector3 PrecisePositions<Real>::harmonic_pull(int v, const std::vector<Neighbour>& neighbours,
                                              double error) const {
  const Space space = gluing().boundary.space;
  const Vector here = precise(v);
  Vector sum = Vector::Zero();
  for (const auto& [u, e, weight] : neighbours) {
    const Vector away = e == 0 ? Vector(precise(u) - here) : Vector(element(e) * precise(u) - here);
    const Real s = space.squared_norm(away);
    sum += Real(weight) * precise_over_sn<Real>(space, s, error) * away;
  }
  return tangential(here, sum);
}

template <typename Real>
void PrecisePositions<Real>::store(int v, const Vector& p) {
  if (!is_refined(v)) {
    slot_[v] = static_cast<int>(digits_.size());
    digits_.emplace_back();
  }
  digits_[slot_[v]] = p;
  set_rounded(v, p.template cast<double>());
}

template <typename Real>
typename PrecisePositions<Real>::Vector PrecisePositions<Real>::feasible(int v, Vector p) const {
  const BoundaryConditions& boundary = gluing().boundary;
  const int basis = boundary.basis_of[v];
  if (basis == held_in_place) return group_.held_point(boundary.held_at(v));
  if (basis != in_space) p += Vector(mirrors_[basis] * p);
  return group_.retract(p);
}

template <typename Real>
void PrecisePositions<Real>::remember_digits(int v) {
  journal_.push_back({moves(), v, digits_[slot_[v]]});
  remember(v);
}

template <typename Real>
void PrecisePositions<Real>::move(int v, const Vector3& step) {
  if (!is_refined(v)) return MovablePositions::move(v, step);
  remember_digits(v);
  store(v, feasible(v, precise(v) + to_precise<Real>(step)));
}

template <typename Real>
void PrecisePositions<Real>::put(int v, int u, int k, const Vector3& step) {
  refine(v);
  remember_digits(v);
  const Vector there = k == 0 ? precise(u) : Vector(element(k) * precise(u));
  store(v, feasible(v, there + to_precise<Real>(step)));
}

template <typename Real>
void PrecisePositions<Real>::shift(int v, const Vector3& step) {
  if (!is_refined(v)) return MovablePositions::shift(v, step);
  remember_digits(v);
  store(v, precise(v) + to_precise<Real>(step));
}

template <typename Real>
void PrecisePositions<Real>::refine(int v) {
  if (!is_refined(v)) store(v, feasible(v, precise(v)));
}

template <typename Real>
void PrecisePositions<Real>::refine_to(int v, const Vector3Of<Real>& point) {
  store(v, feasible(v, point));
}

// As it will be stored: what has no more digits is a double at every copy.
template <typename Real>
typename PrecisePositions<Real>::Vector PrecisePositions<Real>::cut_position(int cut_vertex) const {
  const int source = gluing().cut.source_vertex[cut_vertex];
  if (cut_vertex == source) return precise(source);
  const BoundaryConditions& boundary = gluing().boundary;
  if (is_refined(source)) return transforms_[boundary.transform_of[cut_vertex]] * precise(source);
  return to_precise<Real>(boundary.transform(cut_vertex) * rounded(source));
}

template <typename Real>
bool PrecisePositions<Real>::is_positive(int face) const {
  const auto v = gluing().cut.F.row(face);
  if (std::none_of(v.begin(), v.end(), [&](int c) { return is_refined(gluing().cut.source_vertex[c]); }))
    return MovablePositions::is_positive(face);
  const Vector a = cut_position(v[0]), ab = cut_position(v[1]) - a, ac = cut_position(v[2]) - a;
  return a.dot(Vector(ab.cross(ac))) > 0;
}

template <typename Real>
void PrecisePositions<Real>::take_back(std::size_t moves) {
  for (; !journal_.empty() && journal_.back().move >= moves; journal_.pop_back())
    store(journal_.back().vertex, journal_.back().position);
  MovablePositions::take_back(moves);
}

template <typename Real>
Points PrecisePositions<Real>::spread(const std::vector<double>& shortest_edge,
                                      std::vector<Offset>& offsets) const {
  constexpr double part = 0x1p-50;  // of the shortest edge, which is left out
  constexpr int most = 60;          // offsets of a vertex
  const std::vector<int>& source_vertex = gluing().cut.source_vertex;
  Points result = gluing().boundary.spread(positions(), source_vertex);
  for (int c = 0; c < static_cast<int>(source_vertex.size()); ++c) {
    const int v = source_vertex[c];
    if (!is_refined(v)) continue;
    Vector rest = cut_position(c);
    // Takes away what a double holds of it.
    const auto split = [&rest] {
      Vector3 d = rest.template cast<double>();
      rest -= to_precise<Real>(d);
      return d;
    };
    result.row(c) = split();
    for (int k = 0; k < most && shortest_edge[v] < std::numeric_limits<double>::infinity(); ++k) {
      offsets.push_back({c, split()});
      if (Vector3(rest.template cast<double>()).cwiseAbs().maxCoeff() <= part * shortest_edge[v]) break;
    }
  }
  return result;
}

template class PrecisePositions<Precise>;
template class PrecisePositions<MorePrecise>;

}  // namespace orbitutte
