// SPDX-License-Identifier: MIT
#include "orbitutte/solve/moduli_energy.h"

#include <Eigen/Geometry>
#include <utility>

#include "orbitutte/geometry/space.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// The gradient of d(p, q)^2 by p: -2 d/sn d times the tangential part of q - p.
template <int k>
Vector3 gradient_of_squared_distance(Curvature<k> curvature, const Vector3& p, const Vector3& q) {
  return -2 * curvature.distance(p, q).over_sn * curvature.tangent(p, q - p);
}

}  // namespace

ModuliEnergy::ModuliEnergy(const Moduli& moduli, const EdgeWords& edges, const EdgeWeights& weights,
                           std::vector<int> cones)
    : moduli_(moduli), edges_(edges), weights_(weights), cones_(std::move(cones)) {
  int vertices = 0;
  for (const auto& [i, j, t] : edges.edges) vertices = std::max({vertices, i + 1, j + 1});
  cone_at_.assign(vertices, -1);
  for (std::size_t k = 0; k < cones_.size(); ++k) cone_at_[cones_[k]] = static_cast<int>(k);
  dependent_ = parallel_select(static_cast<int>(edges.edges.size()), [&](int e) {
    const auto& [i, j, t] = edges_.edges[e];
    return t != 0 || cone_at_[i] >= 0 || cone_at_[j] >= 0;
  });
}

std::vector<Isometry> ModuliEnergy::transforms(const Points& cones) const {
  const std::vector<Isometry> rotations = moduli_.rotations(cones);
  std::vector<Isometry> result;
  for (const RotationWord& word : edges_.words)
    result.push_back(product_of_word(word, rotations, Isometry()));
  return result;
}

GluedEdges ModuliEnergy::glued(const Points& cones) const { return {edges_.edges, transforms(cones)}; }

Points ModuliEnergy::with_cones(Points x, const Points& cones) const {
  for (std::size_t k = 0; k < cones_.size(); ++k) x.row(cones_[k]) = cones.row(static_cast<Eigen::Index>(k));
  return x;
}

template <typename Visit>
void ModuliEnergy::for_each(const Points& x, const std::vector<Isometry>& transforms,
                            const Visit& visit) const {
  for (const int e : dependent_) {
    const GluedEdge& edge = edges_.edges[e];
    visit(edge, weights_.w[e], Vector3(x.row(edge.i)), transforms[edge.t] * Vector3(x.row(edge.j)));
  }
}

double ModuliEnergy::energy(const Points& x, const Points& cones) const {
  const Points all = with_cones(x, cones);
  return visit_curvature(moduli_.space(), [&](auto curvature) {
    double sum = 0;
    for_each(all, transforms(cones), [&](const GluedEdge&, double w, const Vector3& p, const Vector3& q) {
      sum += w * curvature.distance(p, q).squared;
    });
    return sum;
  });
}

Points ModuliEnergy::gradient(const Points& x, const Points& cones) const {
  const Points all = with_cones(x, cones);
  const std::vector<Isometry> transform = transforms(cones);
  Points result = Points::Zero(x.rows(), 3);
  visit_curvature(moduli_.space(), [&](auto curvature) {
    for_each(all, transform, [&](const GluedEdge& edge, double w, const Vector3& p, const Vector3& q) {
      result.row(edge.i) += w * gradient_of_squared_distance(curvature, p, q);
      result.row(edge.j) +=
          w * (transform[edge.t].inverse_matrix() * gradient_of_squared_distance(curvature, q, p));
    });
  });
  for (const int v : cones_) result.row(v).setZero();
  if (moduli_.space().curvature() < 0) result.col(2) *= -1;
  return result;
}

// Where q = g x_j moves by the infinitesimal isometry w, d^2 changes by <u, J (w x q)> = w . (q x u), u the
// gradient by q. So each g needs one sum of moments q x u.
Eigen::VectorXd ModuliEnergy::cone_gradient(const Points& x, const Points& cones) const {
  const Points all = with_cones(x, cones);
  const std::vector<VaryingIsometry> rotations = moduli_.varying_rotations(cones);
  const VaryingIsometry identity = {Isometry(), Eigen::Matrix3Xd::Zero(3, 2 * moduli_.mark_count())};
  std::vector<VaryingIsometry> varying;
  std::vector<Isometry> transform;
  for (const RotationWord& word : edges_.words) {
    varying.push_back(product_of_word(word, rotations, identity));
    transform.push_back(varying.back().value);
  }
  Eigen::Matrix3Xd moments = Eigen::Matrix3Xd::Zero(3, static_cast<Eigen::Index>(transform.size()));
  Points at_cones = Points::Zero(cones.rows(), 3);
  visit_curvature(moduli_.space(), [&](auto curvature) {
    for_each(all, transform, [&](const GluedEdge& edge, double w, const Vector3& p, const Vector3& q) {
      const Vector3 u = w * gradient_of_squared_distance(curvature, q, p);
      moments.col(edge.t) += q.cross(u);
      if (const int k = cone_at_[edge.i]; k >= 0)
        at_cones.row(k) += w * gradient_of_squared_distance(curvature, p, q);
      if (const int k = cone_at_[edge.j]; k >= 0) at_cones.row(k) += transform[edge.t].inverse_matrix() * u;
    });
  });
  Eigen::VectorXd result = moduli_.coordinates(cones, at_cones);
  for (std::size_t t = 0; t < varying.size(); ++t)
    result += varying[t].rate.transpose() * moments.col(static_cast<Eigen::Index>(t));
  return result;
}

}  // namespace orbitutte
