// SPDX-License-Identifier: MIT
#include "orbitutte/solve/spherical_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// d(p, q)^2 and d/sin d, as functions of the squared chord.
struct Distance {
  double squared, over_sine;
};

// With s = sin^2(d/2), a quarter of the squared chord: d/sin d = G(s) = sum of 4^k k!^2/(2k + 1)! s^k, and
// since the derivative of (d/2)^2 by s is G, d^2 = 4 sum of G_k/(k + 1) s^(k + 1).
constexpr std::array<double, 9> series = [] {
  std::array<double, 9> G = {1};
  for (std::size_t k = 1; k < G.size(); ++k)
    G[k] = G[k - 1] * static_cast<double>(2 * k) / static_cast<double>(2 * k + 1);
  return G;
}();

// The first terms of both series; the next one is below half a unit in the last place where they are used.
template <std::size_t terms>
Distance short_distance(double s) {
  double squared = 0, over_sine = 0;
  for (std::size_t k = terms; k-- > 0;) {
    squared = squared * s + series[k] / static_cast<double>(k + 1);
    over_sine = over_sine * s + series[k];
  }
  return {4 * s * squared, over_sine};
}

// At d = pi, d/sin d has a pole, where the shortest arc is not unique: the slope is then taken just before
// it, large and finite, so that a line search turns back.
Distance distance(const Vector3& p, const Vector3& q) {
  const double squared_chord = (p - q).squaredNorm(), s = squared_chord / 4;
  if (s < 0x1p-13) return short_distance<4>(s);
  if (s < 0x1p-6) return short_distance<series.size()>(s);
  const double d = 2 * std::atan2(std::sqrt(squared_chord), (p + q).norm());
  return {d * d, d / std::max(std::sin(d), 1e-8)};
}

}  // namespace

GluedEdges glued_edges(const CutMesh& cut, const Connectivity& connectivity,
                       const BoundaryConditions& boundary) {
  GluedEdges result;
  result.transforms = {Matrix3::Identity()};
  result.edges.resize(connectivity.edges.size());
  std::unordered_map<long long, int> known;  // by the transforms of both ends
  for (int h = static_cast<int>(cut.F.size()) - 1; h >= 0; --h) {
    const int a = origin(cut.F, h), b = target(cut.F, h), e = cut.edge_of[h];
    if (e < 0) continue;  // a diagonal
    int t = 0;
    if (const int ta = boundary.transform_of[a], tb = boundary.transform_of[b]; ta != tb) {
      const long long key = static_cast<long long>(ta) << 32 | tb;
      const auto at = known.find(key);
      t = at != known.end()
              ? at->second
              : known[key] = index_among(result.transforms,
                                         inverse_isometry(boundary.transform(a)) * boundary.transform(b));
    }
    result.edges[e] = {cut.source_vertex[a], cut.source_vertex[b], t};
  }
  return result;
}

SphericalEnergy::SphericalEnergy(const GluedEdges& glued, const EdgeWeights& weights,
                                 const BoundaryConditions& boundary)
    : transforms_(glued.transforms), basis_of_(boundary.basis_of) {
  const int n = static_cast<int>(basis_of_.size());
  for (const Basis& basis : boundary.bases) projectors_.push_back(basis * basis.transpose());
  start_.assign(n + 1, 0);
  for (const GluedEdge& edge : glued.edges) {
    ++start_[edge.i + 1];
    ++start_[edge.j + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  incidences_.resize(2 * glued.edges.size());
  std::vector<int> fill(start_.begin(), start_.end() - 1);
  for (std::size_t e = 0; e < glued.edges.size(); ++e) {
    const auto [i, j, t] = glued.edges[e];
    const double w = weights.w[static_cast<Eigen::Index>(e)];
    incidences_[fill[i]++] = {j, 2 * t, w};
    incidences_[fill[j]++] = {i, 2 * t + 1, w};
  }
  rounding_floor_.resize(n);
  for (int v = 0; v < n; ++v) {
    double sum = 0;
    for (int k = start_[v]; k < start_[v + 1]; ++k) sum += incidences_[k].w;
    rounding_floor_[v] = 4 * std::numeric_limits<double>::epsilon() * sum;
  }
}

Vector3 SphericalEnergy::image(const Points& p, const Incidence& incidence) const {
  Vector3 q = p.row(incidence.neighbor);
  if (incidence.transform < 2) return q;
  const Matrix3& g = transforms_[incidence.transform / 2];
  return incidence.transform % 2 == 0 ? Vector3(g * q) : Vector3(g.transpose() * q);
}

SphericalEnergy::Value SphericalEnergy::evaluate(const Points& positions) const {
  Value value;
  evaluate(positions, value);
  return value;
}

void SphericalEnergy::evaluate(const Points& positions, Value& value) const {
  value.gradient.resize(positions.rows(), 3);
  // Every edge is met from both ends, half of its energy at each, and
  // grad_i E = -2 times the tangential, feasible part of sum over j of w_ij d/sin d (g_ij p_j - p_i).
  value.energy = 0.5 * parallel_sum(static_cast<int>(positions.rows()), [&](int v) {
                   const Vector3 here = positions.row(v);
                   Vector3 pull = Vector3::Zero();
                   double energy = 0;
                   for (int k = start_[v]; k < start_[v + 1]; ++k) {
                     const Vector3 there = image(positions, incidences_[k]);
                     const Distance d = distance(here, there);
                     energy += incidences_[k].w * d.squared;
                     pull += incidences_[k].w * d.over_sine * (there - here);
                   }
                   if (basis_of_[v] != 0) pull = projectors_[basis_of_[v]] * pull;
                   pull -= here.dot(pull) * here;
                   value.gradient.row(v) = -2 * pull;
                   return energy;
                 });
}

void SphericalEnergy::make_feasible(Points& vectors) const {
  for (int v = 0; v < static_cast<int>(vectors.rows()); ++v)
    if (basis_of_[v] != 0) vectors.row(v) = projectors_[basis_of_[v]] * Vector3(vectors.row(v));
}

void SphericalEnergy::relax(Points& p, int v) const {
  const Vector3 here = p.row(v);
  Vector3 pull = Vector3::Zero();
  double weight = 0;
  for (int k = start_[v]; k < start_[v + 1]; ++k) {
    const Vector3 there = image(p, incidences_[k]);
    const double w = incidences_[k].w * distance(here, there).over_sine;
    pull += w * (there - here);
    weight += w;
  }
  if (!(weight > 0)) return;
  pull /= weight;
  if (basis_of_[v] != 0) pull = projectors_[basis_of_[v]] * pull;
  pull -= here.dot(pull) * here;
  p.row(v) = (here + pull).normalized();
}

std::pair<int, double> SphericalEnergy::smallest_spot(const Points& positions) const {
  std::pair<int, double> spot = {0, std::numeric_limits<double>::infinity()};
  for (int v = 0; v < static_cast<int>(positions.rows()); ++v) {
    for (int k = start_[v]; k < start_[v + 1]; ++k) {
      const double length = (image(positions, incidences_[k]) - Vector3(positions.row(v))).norm();
      if (length < spot.second) spot = {v, length};
    }
  }
  return spot;
}

void SphericalEnergy::relax_small(Points& positions, double length, int sweeps) const {
  std::vector<int> small;
  for (int v = 0; v < static_cast<int>(positions.rows()); ++v) {
    bool any = false;
    for (int k = start_[v]; k < start_[v + 1] && !any; ++k)
      any = (image(positions, incidences_[k]) - Vector3(positions.row(v))).norm() < length;
    if (any) small.push_back(v);
  }
  for (int sweep = 0; sweep < sweeps; ++sweep)
    for (const int v : small) relax(positions, v);
}

}  // namespace orbitutte
