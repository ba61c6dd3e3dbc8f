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

TangentSystem::TangentSystem(Space space, std::shared_ptr<const Factored> factored, const Points& x)
    : space_(space), frames_(static_cast<std::size_t>(x.rows())), factored_(std::move(factored)) {
  parallel_ranges(static_cast<int>(x.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) frames_[v] = space_.to_origin(x.row(v)).inverse_matrix().leftCols<2>();
  });
}

TangentSystem::TangentSystem(const TangentProblem& problem, const Points& x)
    : TangentSystem(problem.boundary.space, nullptr, x) {
  factored_ = std::make_shared<Factored>(factored(problem, x));
}

TangentSystem TangentSystem::moved_to(const Points& x) const { return {space_, factored_, x}; }

TangentSystem::Factored TangentSystem::factored(const TangentProblem& problem, const Points& x) const {
  Factored result;
  result.unknowns = number_unknowns(problem.dissection.order, tangent_unknowns(problem.boundary));
  if (result.unknowns.total == 0) return result;
  SparseMatrix A = assemble_form(problem, x, result.unknowns, Form::hessian);
  try {
    result.factor = eliminate(A, problem.backend, 0).factor;
  } catch (const NotPositiveDefinite&) {
    result.is_exact = false;
    A = assemble_form(problem, x, result.unknowns, Form::laplacian);
    result.factor = eliminate_laplacian(A, result.unknowns, problem.backend);
  }
  if (problem.w.maxCoeff() > stiff_weight) result.stiff = std::move(A);
  return result;
}

SparseMatrix TangentSystem::assemble_form(const TangentProblem& problem, const Points& x,
                                          const Unknowns& unknowns, Form form) const {
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
        const NormalFactors factors =
            form == Form::hessian ? normal_factors<k>(d.squared, d.over_sn) : NormalFactors();
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
    const long row = unknowns.first[row_vertex], column = unknowns.first[column_vertex];
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
  SparseMatrix lower(unknowns.total, unknowns.total);
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

SinglePoints TangentSystem::solve(const SinglePoints& b) const {
  SinglePoints y = b;
  factored_->factor.forward(y);
  factored_->factor.backward(y);
  return y;
}

Points TangentSystem::precondition(const Points& gradient) const {
  return precondition_all({gradient}).front();
}

std::vector<Points> TangentSystem::precondition_all(const std::vector<Points>& gradients) const {
  const Unknowns& unknowns = factored_->unknowns;
  std::vector<Points> results(gradients.size());
  for (std::size_t first = 0; first < gradients.size(); first += 3) {
    const std::size_t count = std::min<std::size_t>(3, gradients.size() - first);
    SinglePoints b = SinglePoints::Zero(unknowns.total, 3);
    for (const int v : unknowns.order)
      for (std::size_t c = 0; c < count; ++c)
        b.block<2, 1>(unknowns.first[v], static_cast<long>(c)) =
            (frames_[v].transpose() * gradients[first + c].row(v).transpose()).cast<float>();
    SinglePoints y = solve(b);
    if (factored_->stiff.nonZeros() > 0) {
      const Eigen::MatrixXd image =
          factored_->stiff.selfadjointView<Eigen::Lower>() * Eigen::MatrixXd(y.cast<double>());
      y += solve((b.cast<double>() - image).cast<float>());
    }
    for (std::size_t c = 0; c < count; ++c) {
      Points& result = results[first + c] = Points::Zero(gradients[first + c].rows(), 3);
      for (const int v : unknowns.order)
        result.row(v) =
            (frames_[v] * y.block<2, 1>(unknowns.first[v], static_cast<long>(c)).cast<double>()).transpose();
    }
  }
  return results;
}

}  // namespace orbitutte
