// SPDX-License-Identifier: MIT
#include "orbitutte/solve/dirichlet_energy.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <unordered_map>

#include "orbitutte/geometry/near_distance.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// The covector of a tangent vector: its ordinary products with others are those of the metric.
template <int k>
Vector3 lowered(const Vector3& v) {
  return k < 0 ? Vector3(v.x(), v.y(), -v.z()) : v;
}

// Where the series of near points are not exact enough.
template <int k>
DistanceFactors far_factors(const Vector3& p, const double* q) {
  const Vector3 there(q[0], q[1], q[2]), away = there - p;
  const auto d = Curvature<k>::distance(p, there);
  return {d.over_sn, d.squared / Curvature<k>::dot(away, away)};
}

}  // namespace

GluedEdges glued_edges(const CutMesh& cut, const Connectivity& connectivity,
                       const BoundaryConditions& boundary) {
  GluedEdges result;
  result.transforms = {Isometry()};
  result.edges.resize(connectivity.edges.size());
  std::unordered_map<long long, int> known;  // by the transforms of both ends
  for (int h = static_cast<int>(cut.F.size()) - 1; h >= 0; --h) {
    const int a = halfedge_origin(cut.F, h), b = halfedge_target(cut.F, h),
              e = connectivity.edge_of[cut.source_halfedge(h)];
    if (e < 0) continue;  // a diagonal
    int t = 0;
    if (const int ta = boundary.transform_of[a], tb = boundary.transform_of[b]; ta != tb) {
      const long long key = static_cast<long long>(ta) << 32 | tb;
      const auto at = known.find(key);
      t = at != known.end() ? at->second
                            : known[key] = index_among(
                                  result.transforms, boundary.transform(a).inverse() * boundary.transform(b));
    }
    result.edges[e] = {cut.source_vertex[a], cut.source_vertex[b], t};
  }
  return result;
}

DirichletEnergy::DirichletEnergy(const GluedEdges& glued, const EdgeWeights& weights,
                                 const BoundaryConditions& boundary)
    : space_(boundary.space), transforms_(glued.transforms), basis_of_(boundary.basis_of) {
  const int n = static_cast<int>(basis_of_.size());
  for (const Isometry& mirror : boundary.mirrors)
    projectors_.push_back(0.5 * (Matrix3::Identity() + mirror.matrix()));
  projectors_[held_in_place].setZero();
  start_.assign(n + 1, 0);
  parallel_parts(n, [&](int begin, int end) {
    for (const GluedEdge& edge : glued.edges)
      for (const int v : {edge.i, edge.j})
        if (v >= begin && v < end) ++start_[v + 1];
  });
  std::partial_sum(start_.begin(), start_.end(), start_.begin());
  incidences_.resize(2 * glued.edges.size());
  rounding_floor_.setZero(n);
  std::vector<double> size;  // of the numbers by which products with a transform are rounded
  for (const Isometry& g : transforms_) size.push_back(std::max(1.0, g.matrix().cwiseAbs().maxCoeff()));
  parallel_parts(n, [&](int begin, int end) {
    std::vector<int> fill(start_.begin() + begin, start_.begin() + end);
    const auto add = [&](int v, const Incidence& incidence) {
      if (v < begin || v >= end) return;
      incidences_[fill[v - begin]++] = incidence;
      rounding_floor_[v] +=
          4 * std::numeric_limits<double>::epsilon() * size[incidence.transform / 2] * incidence.w;
    };
    for (std::size_t e = 0; e < glued.edges.size(); ++e) {
      const auto [i, j, t] = glued.edges[e];
      const double w = weights.w[static_cast<Eigen::Index>(e)];
      add(i, {j, 2 * t, w});
      add(j, {i, 2 * t + 1, w});
    }
  });
}

inline Vector3 DirichletEnergy::image(const Points& p, const Incidence& incidence) const {
  const Vector3 q = p.row(incidence.neighbor);
  return incidence.transform < 2 ? q : moved(q, incidence);
}

Vector3 DirichletEnergy::moved(const Vector3& q, const Incidence& incidence) const {
  const Isometry& g = transforms_[incidence.transform / 2];
  return incidence.transform % 2 == 0 ? g.matrix() * q : g.inverse_matrix() * q;
}

DirichletEnergy::Value DirichletEnergy::evaluate(const Points& positions) const {
  Value value;
  evaluate(positions, value);
  return value;
}

// x and y of the force are summed side by side, and its z beside the energy.
template <int k>
DirichletEnergy::Pull DirichletEnergy::pull_at(const Points& p, int v) const {
  using Two = Eigen::Array2d;
  const Vector3 here = p.row(v);
  const Two here_xy = here.head<2>();
  Two force_xy(0, 0), force_z_and_energy(0, 0);
  for (int at = start_[v]; at < start_[v + 1]; ++at) {
    const Incidence& incidence = incidences_[at];
    const double* there = p.data() + 3 * static_cast<Eigen::Index>(incidence.neighbor);
    Vector3 behind_seam;
    if (incidence.transform >= 2) {
      behind_seam = moved(Vector3(there[0], there[1], there[2]), incidence);
      there = behind_seam.data();
    }
    const Two away_xy = Two(there[0], there[1]) - here_xy;
    const double away_z = there[2] - here.z();
    const double squared_chord = away_xy.square().sum() + k * (away_z * away_z);
    const Two factors =
        incidence.w * (squared_chord < NearDistance<k>::farthest ? NearDistance<k>::factors(squared_chord)
                                                                 : far_factors<k>(here, there));
    force_xy += factors[0] * away_xy;
    force_z_and_energy += factors * Two(away_z, squared_chord);
  }
  Vector3 force(force_xy[0], force_xy[1], force_z_and_energy[0]);
  if (basis_of_[v] != in_space) force = projectors_[basis_of_[v]] * force;
  return {Curvature<k>::tangent(here, force), force_z_and_energy[1]};
}

void DirichletEnergy::evaluate(const Points& positions, Value& value) const {
  value.gradient.resize(positions.rows(), 3);
  // Every edge is met from both ends, half of its energy at each, and grad_i E = -2 times the pull.
  value.energy = visit_curvature(space_, [&]<int k>(Curvature<k>) {
    return 0.5 * parallel_sum(static_cast<int>(positions.rows()), [&](int v) {
             const Pull pull = pull_at<k>(positions, v);
             value.gradient.row(v) = -2 * lowered<k>(pull.force);
             return pull.energy;
           });
  });
}

void DirichletEnergy::make_feasible(Points& vectors) const {
  parallel_ranges(static_cast<int>(vectors.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      if (basis_of_[v] != 0) vectors.row(v) = projectors_[basis_of_[v]] * Vector3(vectors.row(v));
  });
}

std::vector<double> DirichletEnergy::shortest_edges(const Points& positions) const {
  std::vector<double> shortest(positions.rows(), std::numeric_limits<double>::infinity());
  for (int v = 0; v < static_cast<int>(shortest.size()); ++v)
    for (int k = start_[v]; k < start_[v + 1]; ++k)
      shortest[v] =
          std::min(shortest[v], (image(positions, incidences_[k]) - Vector3(positions.row(v))).norm());
  return shortest;
}

std::pair<int, double> DirichletEnergy::smallest_spot(const Points& positions) const {
  const std::vector<double> shortest = shortest_edges(positions);
  const auto at = std::min_element(shortest.begin(), shortest.end());
  return {static_cast<int>(at - shortest.begin()), *at};
}

std::vector<Neighbour> DirichletEnergy::neighbours(int vertex, Elements& elements) const {
  std::vector<Neighbour> result;
  for (int k = start_[vertex]; k < start_[vertex + 1]; ++k) {
    const auto& [neighbour, transform, w] = incidences_[k];
    const Isometry& g = transforms_[transform / 2];
    result.push_back(
        {neighbour, transform < 2 ? 0 : elements.index(transform % 2 == 0 ? g : g.inverse()), w});
  }
  return result;
}

}  // namespace orbitutte
