// SPDX-License-Identifier: MIT
#include "orbitutte/solve/movable_positions.h"

#include <algorithm>

#include "orbitutte/geometry/orientation.h"

namespace orbitutte {
namespace {

template <typename Real>
Vector3 to_double(const Vector3Of<Real>& p) {
  return {static_cast<double>(p.x()), static_cast<double>(p.y()), static_cast<double>(p.z())};
}

// The corners as they are spread over the cut mesh.
bool is_positive_in_doubles(const Gluing& gluing, const Points& positions, int face) {
  const auto corner = [&](int k) -> Vector3 {
    const int v = gluing.cut.F(face, k), source = gluing.cut.source_vertex[v];
    const Vector3 p = positions.row(source);
    return v == source ? p : gluing.boundary.transform(v) * p;
  };
  return orientation_sign(corner(0), corner(1), corner(2)) > 0;
}

}  // namespace

Vector3 PlainPositions::difference(int v, int u, int element) const {
  const Vector3 there = positions_.row(u), here = positions_.row(v);
  return (element == 0 ? there : gluing_.elements[element] * there) - here;
}

Vector3 PlainPositions::pull(int v, const std::vector<Neighbour>& neighbours,
                             const std::vector<double>& factors) const {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < neighbours.size(); ++k)
    sum += factors[k] * difference(v, neighbours[k].vertex, neighbours[k].element);
  return gluing_.boundary.space.tangent(positions_.row(v), sum);
}

void PlainPositions::move(int v, const Vector3& step) {
  journal_.emplace_back(v, positions_.row(v));
  positions_.row(v) = gluing_.boundary.feasible(v, positions_.row(v).transpose() + step);
}

void PlainPositions::shift(int v, const Vector3& step) {
  journal_.emplace_back(v, positions_.row(v));
  positions_.row(v) += step;
}

bool PlainPositions::is_positive(int face) const { return is_positive_in_doubles(gluing_, positions_, face); }

void PlainPositions::take_back(std::size_t moves) {
  for (; journal_.size() > moves; journal_.pop_back())
    positions_.row(journal_.back().first) = journal_.back().second;
}

template <typename Real>
PrecisePositions<Real>::PrecisePositions(Gluing gluing, const Points& positions, const Target& target)
    : gluing_(gluing), group_(target), positions_(positions), slot_(positions.rows(), -1) {
  const BoundaryConditions& boundary = gluing.boundary;
  for (const Isometry& transform : boundary.transforms) transforms_.push_back(group_.element(transform));
  for (const Isometry& mirror : boundary.mirrors) mirrors_.push_back(group_.element(mirror));
}

template <typename Real>
typename PrecisePositions<Real>::Vector PrecisePositions<Real>::precise(int v) const {
  if (slot_[v] >= 0) return digits_[slot_[v]];
  return Vector(positions_(v, 0), positions_(v, 1), positions_(v, 2));
}

template <typename Real>
const typename PrecisePositions<Real>::Matrix& PrecisePositions<Real>::element(int k) const {
  if (static_cast<int>(elements_.size()) <= k) elements_.resize(k + 1);
  if (!elements_[k]) elements_[k] = group_.element(gluing_.elements[k]);
  return *elements_[k];
}

template <typename Real>
Vector3 PrecisePositions<Real>::difference(int v, int u, int k) const {
  if (slot_[v] < 0 && slot_[u] < 0) {
    const Vector3 there = positions_.row(u), here = positions_.row(v);
    return (k == 0 ? there : gluing_.elements[k] * there) - here;
  }
  const Vector there = k == 0 ? precise(u) : Vector(element(k) * precise(u));
  return to_double<Real>(there - precise(v));
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
  const int curvature = gluing_.boundary.space.curvature();
  const Real off = here.z() * sum.z() + curvature * (here.x() * sum.x() + here.y() * sum.y());
  return to_double<Real>(sum - off * here);  // see Curvature::tangent
}

template <typename Real>
void PrecisePositions<Real>::store(int v, const Vector& p) {
  if (slot_[v] < 0) {
    slot_[v] = static_cast<int>(digits_.size());
    digits_.emplace_back();
  }
  digits_[slot_[v]] = p;
  positions_.row(v) = to_double<Real>(p);
}

template <typename Real>
typename PrecisePositions<Real>::Vector PrecisePositions<Real>::feasible(int v, Vector p) const {
  const int basis = gluing_.boundary.basis_of[v];
  if (basis == held_in_place) return group_.held_point(gluing_.boundary.held.row(v).transpose());
  if (basis != in_space) p += Vector(mirrors_[basis] * p);
  return group_.retract(p);
}

template <typename Real>
void PrecisePositions<Real>::move(int v, const Vector3& step) {
  journal_.emplace_back(v, precise(v));
  if (slot_[v] < 0)
    positions_.row(v) = gluing_.boundary.feasible(v, positions_.row(v).transpose() + step);
  else
    store(v, feasible(v, journal_.back().second + Vector(step.x(), step.y(), step.z())));
}

template <typename Real>
void PrecisePositions<Real>::shift(int v, const Vector3& step) {
  journal_.emplace_back(v, precise(v));
  if (slot_[v] < 0)
    positions_.row(v) += step;
  else
    store(v, journal_.back().second + Vector(step.x(), step.y(), step.z()));
}

template <typename Real>
void PrecisePositions<Real>::refine(int v) {
  if (slot_[v] < 0) store(v, feasible(v, precise(v)));
}

// As it will be stored: what has no more digits is a double at every copy.
template <typename Real>
typename PrecisePositions<Real>::Vector PrecisePositions<Real>::cut_position(int cut_vertex) const {
  const int source = gluing_.cut.source_vertex[cut_vertex];
  if (cut_vertex == source) return precise(source);
  if (slot_[source] >= 0) return transforms_[gluing_.boundary.transform_of[cut_vertex]] * precise(source);
  const Vector3 p = gluing_.boundary.transform(cut_vertex) * positions_.row(source).transpose();
  return Vector(p.x(), p.y(), p.z());
}

template <typename Real>
bool PrecisePositions<Real>::is_positive(int face) const {
  const auto v = gluing_.cut.F.row(face);
  if (std::none_of(v.begin(), v.end(), [&](int c) { return slot_[gluing_.cut.source_vertex[c]] >= 0; }))
    return is_positive_in_doubles(gluing_, positions_, face);
  const Vector a = cut_position(v[0]), ab = cut_position(v[1]) - a, ac = cut_position(v[2]) - a;
  return a.dot(Vector(ab.cross(ac))) > 0;
}

template <typename Real>
void PrecisePositions<Real>::take_back(std::size_t moves) {
  for (; journal_.size() > moves; journal_.pop_back()) {
    const auto& [v, p] = journal_.back();
    if (slot_[v] < 0)
      positions_.row(v) = to_double<Real>(p);
    else
      store(v, p);
  }
}

template <typename Real>
Points PrecisePositions<Real>::spread(const std::vector<double>& shortest_edge,
                                      std::vector<Offset>& offsets) const {
  constexpr double part = 0x1p-50;  // of the shortest edge, which is left out
  constexpr int most = 60;          // offsets of a vertex
  const std::vector<int>& source_vertex = gluing_.cut.source_vertex;
  Points result = gluing_.boundary.spread(positions_, source_vertex);
  for (int c = 0; c < static_cast<int>(source_vertex.size()); ++c) {
    const int v = source_vertex[c];
    if (slot_[v] < 0) continue;
    Vector rest = cut_position(c);
    const Vector3 first = to_double<Real>(rest);
    result.row(c) = first;
    rest -= Vector(first.x(), first.y(), first.z());
    for (int k = 0; k < most; ++k) {
      const Vector3 d = to_double<Real>(rest);
      offsets.push_back({c, d});
      rest -= Vector(d.x(), d.y(), d.z());
      if (to_double<Real>(rest).cwiseAbs().maxCoeff() <= part * shortest_edge[v]) break;
    }
  }
  return result;
}

template class PrecisePositions<Precise>;
template class PrecisePositions<MostPrecise>;

}  // namespace orbitutte
