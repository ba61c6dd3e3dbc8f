// SPDX-License-Identifier: MIT
#include "orbitutte/solve/spherical_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

namespace orbitutte {
namespace {

// d(p, q) of unit vectors, accurate for neighbours and for antipodes.
double spherical_distance(const Vector3& p, const Vector3& q) {
  return 2 * std::atan2((p - q).norm(), (p + q).norm());
}

// d/sin d, which is 1 at d = 0. It has a pole at d = pi, where the shortest arc is not unique: the edge's
// slope is then taken just before it, large and finite, so that a line search turns back.
double distance_over_sine(double d) {
  if (d < 1e-4) return 1 + d * d / 6;
  return d / std::max(std::sin(d), 1e-8);
}

constexpr int block =
    4096;  // edges are summed block by block, so that the sum does not depend on the threads

}  // namespace

GluedEdges glued_edges(const CutMesh& cut, const Connectivity& connectivity,
                       const BoundaryConditions& boundary) {
  GluedEdges result;
  result.transforms = {Matrix3::Identity()};
  result.edges.resize(connectivity.edges.size());
  result.edge_of = connectivity.edge_of;
  std::unordered_map<long long, int> known;  // by the transforms of both ends
  for (int h = static_cast<int>(cut.F.size()) - 1; h >= 0; --h) {
    const int a = origin(cut.F, h), b = target(cut.F, h);
    int t = 0;
    if (const int ta = boundary.transform_of[a], tb = boundary.transform_of[b]; ta != tb) {
      const long long key = static_cast<long long>(ta) << 32 | tb;
      const auto at = known.find(key);
      t = at != known.end()
              ? at->second
              : known[key] =
                    index_among(result.transforms, boundary.transform(a).transpose() * boundary.transform(b));
    }
    result.edges[connectivity.edge_of[h]] = {cut.source_vertex[a], cut.source_vertex[b], t};
  }
  return result;
}

SphericalEnergy::SphericalEnergy(const GluedEdges& glued, const EdgeWeights& weights,
                                 const BoundaryConditions& boundary)
    : glued_(glued), w_(weights.w), basis_of_(boundary.basis_of), slope_(glued.edges.size()) {
  const int n = static_cast<int>(basis_of_.size());
  for (const Basis& basis : boundary.bases) projectors_.push_back(basis * basis.transpose());
  start_.assign(n + 1, 0);
  for (const GluedEdge& edge : glued_.edges) {
    ++start_[edge.i + 1];
    ++start_[edge.j + 1];
  }
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  incidences_.resize(2 * glued_.edges.size());
  std::vector<int> fill(start_.begin(), start_.end() - 1);
  Eigen::VectorXd weight_sum = Eigen::VectorXd::Zero(n);
  for (int e = 0; e < static_cast<int>(glued_.edges.size()); ++e) {
    const auto [i, j, t] = glued_.edges[e];
    incidences_[fill[i]++] = {j, e, 2 * t};
    incidences_[fill[j]++] = {i, e, 2 * t + 1};
    weight_sum[i] += w_[e];
    weight_sum[j] += w_[e];
  }
  rounding_floor_ = 4 * std::numeric_limits<double>::epsilon() * weight_sum;
}

Vector3 SphericalEnergy::image(const Points& p, const Incidence& incidence) const {
  Vector3 q = p.row(incidence.neighbor);
  if (incidence.transform < 2) return q;
  const Matrix3& g = glued_.transforms[incidence.transform / 2];
  return incidence.transform % 2 == 0 ? Vector3(g * q) : Vector3(g.transpose() * q);
}

void SphericalEnergy::evaluate_edges(const Points& p, double& energy) const {
  const int count = static_cast<int>(glued_.edges.size());
  const int blocks = (count + block - 1) / block;
  std::vector<double> partial(blocks, 0.0);
#pragma omp parallel for schedule(static)
  for (int b = 0; b < blocks; ++b) {
    double sum = 0;
    for (int e = b * block; e < std::min(count, (b + 1) * block); ++e) {
      const GluedEdge& edge = glued_.edges[e];
      const double d = spherical_distance(p.row(edge.i), image(p, {edge.j, e, 2 * edge.t}));
      sum += w_[e] * d * d;
      slope_[e] = w_[e] * distance_over_sine(d);
    }
    partial[b] = sum;
  }
  energy = std::accumulate(partial.begin(), partial.end(), 0.0);
}

SphericalEnergy::Value SphericalEnergy::evaluate(const Points& x) const {
  const int n = static_cast<int>(x.rows());
  const Eigen::VectorXd length = x.rowwise().norm();
  const Points p = x.array().colwise() / length.array();
  Value value;
  evaluate_edges(p, value.energy);
  value.gradient.resize(n, 3);
  // grad_i E = -2/|x_i| times the tangential, feasible part of sum over j of w_ij d/sin d (g_ij p_j - p_i).
#pragma omp parallel for schedule(static)
  for (int v = 0; v < n; ++v) {
    const Vector3 here = p.row(v);
    Vector3 pull = Vector3::Zero();
    for (int k = start_[v]; k < start_[v + 1]; ++k)
      pull += slope_[incidences_[k].edge] * (image(p, incidences_[k]) - here);
    if (basis_of_[v] != 0) pull = projectors_[basis_of_[v]] * pull;
    pull -= here.dot(pull) * here;
    value.gradient.row(v) = -2 / length[v] * pull;
  }
  return value;
}

void SphericalEnergy::relax(Points& p, int v) const {
  const Vector3 here = p.row(v);
  Vector3 pull = Vector3::Zero();
  double weight = 0;
  for (int k = start_[v]; k < start_[v + 1]; ++k) {
    const Vector3 there = image(p, incidences_[k]);
    const double w = w_[incidences_[k].edge] * distance_over_sine(spherical_distance(here, there));
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
