// SPDX-License-Identifier: MIT
#include "orbitutte/solve/tangent_system.h"

#include <Eigen/Geometry>
#include <cmath>
#include <utility>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using Block2 = Eigen::Matrix2d;
using Row2 = Eigen::RowVector2d;

// The second derivative of d^2/2 along one edge, in the frames of its ends.
struct EdgeHessian {
  Block2 ii, jj, ij;
};

// The two numbers in the second derivative of the squared distance: d ct d and d/sn d.
struct NormalFactors {
  double own = 1, mixed = 1;
};

template <int k>
NormalFactors normal_factors(double squared_distance, double over_sn) {
  const double d = std::sqrt(squared_distance);
  return {over_sn * (k > 0 ? std::cos(d) : k < 0 ? std::cosh(d) : 1), over_sn};
}

// The unit vector along `log`, in a frame, any one for a vector of no length.
Row2 unit_in_frame(const Vector3& log, const Eigen::Matrix<double, 3, 2>& lowered_frame) {
  const Row2 coordinates = log.transpose() * lowered_frame;
  const double length = coordinates.norm();
  return length > 0 ? Row2(coordinates / length) : Row2(1, 0);
}

Row2 turned_left(const Row2& v) { return {-v.y(), v.x()}; }

EdgeHessian hessian_along(const Row2& at_p, const Row2& at_q, const NormalFactors& factors) {
  const Row2 n_p = turned_left(at_p), n_q = turned_left(at_q);
  return {at_p.transpose() * at_p + factors.own * n_p.transpose() * n_p,
          at_q.transpose() * at_q + factors.own * n_q.transpose() * n_q,
          -at_p.transpose() * at_q - factors.mixed * n_p.transpose() * n_q};
}

// The room of a vertex in its tangent plane.
std::vector<int> tangent_unknowns(const BoundaryConditions& boundary) {
  std::vector<int> count;
  for (const int basis : boundary.basis_of) count.push_back(basis == held_in_place ? 0 : 2);
  return count;
}

}  // namespace

TangentSystem::TangentSystem(const TangentProblem& problem, const Points& x)
    : unknowns_(number_unknowns(problem.dissection.order, tangent_unknowns(problem.boundary))) {
  const Space space = problem.boundary.space;
  frames_.resize(static_cast<std::size_t>(x.rows()));
  parallel_ranges(static_cast<int>(x.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) frames_[v] = space.to_origin(x.row(v)).inverse_matrix().leftCols<2>();
  });
  if (unknowns_.total == 0) return;
  try {
    factor_ = factorize(assemble_hessian(problem, x, true), problem.backend);
  } catch (const NotPositiveDefinite&) {
    is_exact_ = false;
    factor_ = factorize_laplacian(assemble_hessian(problem, x, false), unknowns_, problem.backend);
  }
}

TangentSystem::~TangentSystem() = default;

SparseMatrix TangentSystem::assemble_hessian(const TangentProblem& problem, const Points& x,
                                             bool is_exact) const {
  const std::vector<GluedEdge>& edges = problem.glued.edges;
  const int k_of_space = problem.boundary.space.curvature();
  const auto lowered = [&](int v) {
    Frame frame = frames_[v];
    frame.row(2) *= k_of_space;
    return frame;
  };
  std::vector<EdgeHessian> hessians(edges.size());
  visit_curvature(problem.boundary.space, [&]<int k>(Curvature<k> curvature) {
    parallel_ranges(static_cast<int>(edges.size()), [&](int begin, int end) {
      for (int e = begin; e < end; ++e) {
        const auto& [i, j, t] = edges[e];
        const Isometry& g = problem.glued.transforms[t];
        const Vector3 p = x.row(i), x_j = x.row(j), q = g * x_j, seen = g.inverse_matrix() * p;
        const auto d = curvature.distance(p, q);
        const NormalFactors factors = is_exact ? normal_factors<k>(d.squared, d.over_sn) : NormalFactors();
        const Row2 e_p = unit_in_frame(curvature.tangent(p, q - p), lowered(i)),
                   e_q = -unit_in_frame(curvature.tangent(x_j, seen - x_j), lowered(j));
        const EdgeHessian one = hessian_along(e_p, e_q, factors);
        const double w = 2 * problem.w[e];
        hessians[e] = {w * one.ii, w * one.jj, w * one.ij};
      }
    });
  });
  std::vector<Eigen::Triplet<double, long>> entries;
  entries.reserve(10 * edges.size());
  const auto add = [&](int row_vertex, int column_vertex, const Block2& block) {
    const long row = unknowns_.first[row_vertex], column = unknowns_.first[column_vertex];
    if (row < 0 || column < 0) return;
    for (int r = 0; r < 2; ++r)
      for (int c = 0; c < 2; ++c)
        if (row + r >= column + c) entries.emplace_back(row + r, column + c, block(r, c));
  };
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [i, j, t] = edges[e];
    add(i, i, hessians[e].ii);
    add(j, j, hessians[e].jj);
    add(i, j, hessians[e].ij);
    add(j, i, hessians[e].ij.transpose());
  }
  SparseMatrix lower(unknowns_.total, unknowns_.total);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

Points TangentSystem::precondition(const Points& gradient) const {
  Points result = Points::Zero(gradient.rows(), 3);
  if (!factor_) return result;
  Eigen::MatrixXd b(unknowns_.total, 1);
  for (const int v : unknowns_.order)
    b.block<2, 1>(unknowns_.first[v], 0) = frames_[v].transpose() * gradient.row(v).transpose();
  const Eigen::MatrixXd y = factor_->solve(b);
  for (const int v : unknowns_.order)
    result.row(v) = (frames_[v] * y.block<2, 1>(unknowns_.first[v], 0)).transpose();
  return result;
}

}  // namespace orbitutte
