// SPDX-License-Identifier: MIT
#include "orbitutte/solve/local_minimum.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "orbitutte/geometry/space.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

constexpr int most_steps = 40;
constexpr int patience = 4;  // steps without gain
// Changes of an edge relative to its length: where no further step is needed, and where rounding may end it.
constexpr double converged_change = 1e-9, settled_change = 1e-3;

// The same of all vertices together: triangles may be far flatter than their shortest edges.
constexpr double placed_change = 1e-14;

// The second derivatives of d^2/2, d the length of an edge, by steps of its ends p and q. Along the edge,
// with the unit tangents t there that point to the other end, they are <t, a> <t, b> for two steps, whichever
// the ends; across it d cs d/sn d at one end and -d/sn d between both, since d^2/2 is a function of cs d.
class EdgeStiffness {
 public:
  // away: q - p.
  EdgeStiffness(Space space, const Vector3& away) : space_(space), away_(away) {
    constexpr double flat = 1e-16;
    const double k = space.curvature(), s = space.dot(away, away);
    if (k == 0 || !(s > flat)) return;
    cs_ = 1 - k * s / 2;
    squared_sn_ = s * (1 - k * s / 4);
    visit_curvature(space, [&]<int sign>(Curvature<sign>) { over_sn_ = Curvature<sign>::over_sn(s); });
  }

  // Of two steps of p: the parts along the edge are <t, a> = <q - p, a>/sn d.
  double at_one_end(const Vector3& a, const Vector3& b) const {
    const double along = along_edge(a, b);
    return along + over_sn_ * cs_ * (space_.dot(a, b) - along);
  }

  // Of a step of p and one of q, where t points to p; <a, b> is the product of the parts across the edge,
  // less cs d times that of those along it.
  double between_ends(const Vector3& a, const Vector3& b) const {
    const double along = -along_edge(a, b);
    return along - over_sn_ * (space_.dot(a, b) + cs_ * along);
  }

 private:
  double along_edge(const Vector3& a, const Vector3& b) const {
    return squared_sn_ > 0 ? space_.dot(away_, a) * space_.dot(away_, b) / squared_sn_ : 0.0;
  }

  Space space_;
  Vector3 away_;
  double cs_ = 1, squared_sn_ = 0, over_sn_ = 1;
};

}  // namespace

// The directions tangent to the space in which a vertex may move, orthonormal.
LocalMinimum::Basis LocalMinimum::basis_at(const Vector3& p, int vertex) const {
  const Room& room = gluing_.boundary.basis(vertex);
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
    : gluing_(gluing),
      space_(gluing.boundary.space),
      neighbourhoods_(std::move(neighbourhoods)),
      first_({0}) {
  for (const Neighbourhood& at : neighbourhoods_) {
    place_[at.vertex] = static_cast<int>(bases_.size());
    bases_.push_back(basis_at(positions.rounded(at.vertex), at.vertex));
    first_.push_back(first_.back() + static_cast<int>(bases_.back().cols()));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t k = 0; k < neighbourhoods_.size(); ++k) {
    const Basis& here = bases_[k];
    Eigen::MatrixXd own = Eigen::MatrixXd::Zero(here.cols(), here.cols());
    for (const Neighbour& neighbour : neighbourhoods_[k].neighbours) {
      const EdgeStiffness edge(
          space_, positions.difference(neighbourhoods_[k].vertex, neighbour.vertex, neighbour.element));
      for (Eigen::Index i = 0; i < here.cols(); ++i)
        for (Eigen::Index j = 0; j < here.cols(); ++j)
          own(i, j) += neighbour.weight * edge.at_one_end(here.col(i), here.col(j));
      const auto other = place_.find(neighbour.vertex);
      if (other == place_.end()) continue;
      const Basis& there = bases_[other->second];
      for (Eigen::Index j = 0; j < there.cols(); ++j) {
        const Vector3 seen = gluing_.elements[neighbour.element] * Vector3(there.col(j));
        for (Eigen::Index i = 0; i < here.cols(); ++i)
          entries.emplace_back(first_[k] + i, first_[other->second] + j,
                               neighbour.weight * edge.between_ends(here.col(i), seen));
      }
    }
    for (Eigen::Index i = 0; i < here.cols(); ++i)
      for (Eigen::Index j = 0; j < here.cols(); ++j)
        entries.emplace_back(first_[k] + i, first_[k] + j, own(i, j));
  }
  Eigen::SparseMatrix<double> matrix(first_.back(), first_.back());
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor_.compute(matrix);
}

LocalMinimum::Change LocalMinimum::step(MovablePositions& positions, double error) const {
  const std::size_t count = neighbourhoods_.size();
  positions.prepare_elements(gluing_.elements.count() - 1);
  Eigen::VectorXd force(first_.back());
  parallel_for(static_cast<int>(count), [&](int n) {
    const auto& [vertex, neighbours] = neighbourhoods_[n];
    const Vector3 pull = positions.harmonic_pull(vertex, neighbours, error);
    for (Eigen::Index i = 0; i < bases_[n].cols(); ++i)
      force[first_[n] + i] = space_.dot(bases_[n].col(i), pull);
  });
  const Eigen::VectorXd move = factor_.solve(force);
  std::vector<Vector3> steps(count, Vector3::Zero());
  for (std::size_t n = 0; n < count; ++n)
    if (bases_[n].cols() > 0) steps[n] = bases_[n] * move.segment(first_[n], bases_[n].cols());
  const Change change = change_by(positions, steps);
  for (std::size_t n = 0; n < count; ++n)
    if (bases_[n].cols() > 0) positions.move(neighbourhoods_[n].vertex, steps[n]);
  return change;
}

LocalMinimum::Change LocalMinimum::change_by(const MovablePositions& positions,
                                             const std::vector<Vector3>& steps) const {
  std::vector<Change> changes(neighbourhoods_.size());
  parallel_for(static_cast<int>(changes.size()), [&](int n) {
    Change& result = changes[n];
    double shortest = std::numeric_limits<double>::infinity();
    for (const Neighbour& at : neighbourhoods_[n].neighbours) {
      const auto other = place_.find(at.vertex);
      Vector3 change = -steps[n];
      if (other != place_.end()) change += gluing_.elements[at.element] * steps[other->second];
      const double length = positions.difference(neighbourhoods_[n].vertex, at.vertex, at.element).norm();
      const double relative = length > 0 ? change.norm() / length : std::numeric_limits<double>::max();
      if (change.norm() > 0) result.largest = std::max(result.largest, relative);
      if (change.norm() > 0 && !(relative < settled_change)) ++result.unsettled;
      shortest = std::min(shortest, length);
    }
    if (const double step = steps[n].norm(); step > 0)
      result.shift = shortest > 0 ? step / shortest : std::numeric_limits<double>::max();
  });
  Change result;
  for (const Change& change : changes) {
    result.largest = std::max(result.largest, change.largest);
    result.unsettled += change.unsettled;
    result.shift = std::max(result.shift, change.shift);
  }
  return result;
}

double LocalMinimum::shortest_edge(const MovablePositions& positions) const {
  double shortest = std::numeric_limits<double>::infinity();
  for (const auto& [vertex, neighbours] : neighbourhoods_)
    for (const Neighbour& at : neighbours)
      if (const double length = positions.difference(vertex, at.vertex, at.element).norm(); length > 0)
        shortest = std::min(shortest, length);
  return shortest;
}

bool LocalMinimum::settle_in_place(MovablePositions& positions) const {
  constexpr int most_steps_in_place = 150, patience_in_place = 12;
  if (factor_.info() != Eigen::Success) return false;
  // What all edges together may miss must not show in the place of the shortest ones.
  const double error = 1e-3 * placed_change * shortest_edge(positions);
  double best = std::numeric_limits<double>::infinity();
  for (int k = 0, without_gain = 0; k < most_steps_in_place && without_gain < patience_in_place; ++k) {
    const double shift = step(positions, error).shift;
    if (!std::isfinite(shift)) return false;
    if (shift < placed_change) return true;
    without_gain = shift < 0.9 * best ? 0 : without_gain + 1;
    best = std::min(best, shift);
  }
  return false;
}

bool LocalMinimum::settle(MovablePositions& positions) const {
  if (factor_.info() != Eigen::Success) return false;
  Change best = {std::numeric_limits<double>::infinity(), std::numeric_limits<int>::max()};
  for (int k = 0, without_gain = 0; k < most_steps && without_gain < patience; ++k) {
    const Change change = step(positions);
    if (!std::isfinite(change.largest)) return false;
    if (change.largest < converged_change) return true;
    const bool gains = change.largest < 0.5 * best.largest || change.unsettled < best.unsettled;
    without_gain = gains ? 0 : without_gain + 1;
    best = {std::min(best.largest, change.largest), std::min(best.unsettled, change.unsettled)};
  }
  return best.unsettled == 0;
}

}  // namespace orbitutte
