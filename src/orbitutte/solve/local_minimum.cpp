// SPDX-License-Identifier: MIT
#include "orbitutte/solve/local_minimum.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <unordered_map>

#include "orbitutte/geometry/space.h"

namespace orbitutte {
namespace {

constexpr int most_steps = 40;
constexpr double small_part = 1e-6;  // of the shortest edge, below which a move does not matter

}  // namespace

// The directions tangent to the space in which a vertex may move, orthonormal.
LocalMinimum::Basis LocalMinimum::basis_at(const Gluing& gluing, const Vector3& p, int vertex) const {
  const Room& room = gluing.boundary.basis(vertex);
  Basis basis(3, 0);
  for (Eigen::Index k = 0; k < room.cols() && basis.cols() < 2; ++k) {
    Vector3 direction = space_.tangent(p, room.col(k));
    for (Eigen::Index j = 0; j < basis.cols(); ++j)
      direction -= space_.dot(basis.col(j), direction) * basis.col(j);
    if (const double length = space_.norm(direction); length > 0.1) {
      basis.conservativeResize(3, basis.cols() + 1);
      basis.col(basis.cols() - 1) = direction / length;
    }
  }
  return basis;
}

LocalMinimum::LocalMinimum(const Gluing& gluing, const MovablePositions& positions,
                           std::vector<Neighbourhood> neighbourhoods)
    : space_(gluing.boundary.space), neighbourhoods_(std::move(neighbourhoods)), first_({0}) {
  std::unordered_map<int, int> place;
  for (const Neighbourhood& at : neighbourhoods_) {
    place[at.vertex] = static_cast<int>(bases_.size());
    bases_.push_back(basis_at(gluing, positions.rounded(at.vertex), at.vertex));
    first_.push_back(first_.back() + static_cast<int>(bases_.back().cols()));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < neighbourhoods_.size(); ++k) {
    double sum = 0;
    for (const Neighbour& neighbour : neighbourhoods_[k].neighbours) {
      sum += neighbour.weight;
      const auto other = place.find(neighbour.vertex);
      if (other == place.end()) continue;
      const Basis& there = bases_[other->second];
      for (Eigen::Index j = 0; j < there.cols(); ++j) {
        const Vector3 seen = gluing.elements[neighbour.element] * Vector3(there.col(j));
        for (Eigen::Index i = 0; i < bases_[k].cols(); ++i)
          entries.emplace_back(first_[k] + i, first_[other->second] + j,
                               -neighbour.weight * space_.dot(bases_[k].col(i), seen));
      }
    }
    for (int i = first_[k]; i < first_[k + 1]; ++i) entries.emplace_back(i, i, sum);
  }
  Eigen::SparseMatrix<double> matrix(first_.back(), first_.back());
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(matrix);
}

double LocalMinimum::step(MovablePositions& positions) const {
  const std::size_t count = neighbourhoods_.size();
  Eigen::VectorXd force(first_.back());
  std::vector<double> shortest(count, std::numeric_limits<double>::infinity());
  visit_curvature(space_, [&]<int k>(Curvature<k>) {
    for (std::size_t n = 0; n < count; ++n) {
      Vector3 pull = Vector3::Zero();
      for (const Neighbour& at : neighbourhoods_[n].neighbours) {
        const Vector3 difference = positions.difference(neighbourhoods_[n].vertex, at.vertex, at.element);
        const double chord = space_.norm(difference);
        shortest[n] = std::min(shortest[n], chord);
        pull += at.weight * Curvature<k>::over_sn(chord * chord) * difference;
      }
      for (Eigen::Index i = 0; i < bases_[n].cols(); ++i)
        force[first_[n] + i] = space_.dot(bases_[n].col(i), pull);
    }
  });
  const Eigen::VectorXd move = factor_.solve(force);
  double longest = 0;
  for (std::size_t n = 0; n < count; ++n) {
    if (bases_[n].cols() == 0) continue;
    const Vector3 step = bases_[n] * move.segment(first_[n], bases_[n].cols());
    if (shortest[n] > 0) longest = std::max(longest, step.norm() / shortest[n]);
    positions.move(neighbourhoods_[n].vertex, step);
  }
  return longest;
}

bool LocalMinimum::settle(MovablePositions& positions) const {
  if (factor_.info() != Eigen::Success) return false;
  for (int k = 0; k < most_steps; ++k) {
    const double longest = step(positions);
    if (!std::isfinite(longest)) return false;
    if (longest < small_part) return true;
  }
  return false;
}

}  // namespace orbitutte
