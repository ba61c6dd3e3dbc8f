// SPDX-License-Identifier: MIT
#include "orbitutte/solve/tangent_system.h"

#include <Eigen/Geometry>
#include <algorithm>
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
  const double d = std::sqrt(std::max(squared_distance, 0.0));  // rounding makes some of the least negative
  return {over_sn * (k > 0 ? std::cos(d) : k < 0 ? std::cosh(d) : 1), over_sn};
}

// The unit vector along `log`, in a frame, any one for a vector of no length.
Row2 unit_in_frame(const Vector3& log, const Eigen::Matrix<double, 3, 2>& lowered_frame) {
  const Row2 coordinates = log.transpose() * lowered_frame;
  const double length = coordinates.norm();
  return length > 0 ? Row2(coordinates / length) : Row2(1, 0);
}

Row2 turned_left(const Row2& v) { return {-v.y(), v.x()}; }

// The directions along an edge in the frames of its ends, and across it, of which the image of n_q is on the
// same side as n_p.
struct EdgeDirections {
  Row2 at_p, at_q, n_p, n_q;
};

EdgeHessian hessian_along(const EdgeDirections& directions, const NormalFactors& factors) {
  const auto& [at_p, at_q, n_p, n_q] = directions;
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

// The lower triangle of a matrix of 2 x 2 blocks, one for each vertex and each edge between two that have
// unknowns.
class BlockMatrix {
 public:
  BlockMatrix(const Unknowns& unknowns, const std::vector<GluedEdge>& edges)
      : unknowns_(unknowns), matrix_(unknowns.total, unknowns.total) {
    const std::vector<std::vector<long>> below = blocks_below(edges);
    long* const start = matrix_.outerIndexPtr();
    start[0] = 0;
    for (long column = 0; column < unknowns.total; ++column)
      start[column + 1] = start[column] + 2 * static_cast<long>(below[column / 2].size()) + 2 - column % 2;
    matrix_.resizeNonZeros(start[unknowns.total]);
    std::fill_n(matrix_.valuePtr(), matrix_.nonZeros(), 0.0);
    for (long column = 0; column < unknowns.total; ++column) {
      long* row = matrix_.innerIndexPtr() + start[column];
      for (long own = column; own < column / 2 * 2 + 2; ++own) *row++ = own;
      for (const long first : below[column / 2]) {
        *row++ = first;
        *row++ = first + 1;
      }
    }
  }

  // To the rows of one vertex and the columns of another. What lies above the diagonal is left out.
  void add(int row_vertex, int column_vertex, const Block2& block) {
    const long row = unknowns_.first[row_vertex], column = unknowns_.first[column_vertex];
    if (column < 0 || row < column) return;
    const long* const start = matrix_.outerIndexPtr() + column;
    double* const value = matrix_.valuePtr();
    if (row == column) {
      value[start[0]] += block(0, 0);
      value[start[0] + 1] += block(1, 0);
      value[start[1]] += block(1, 1);
      return;
    }
    long within = 2;
    while (matrix_.innerIndexPtr()[start[0] + within] != row) within += 2;
    for (int r = 0; r < 2; ++r) {
      value[start[0] + within + r] += block(r, 0);
      value[start[1] + within - 1 + r] += block(r, 1);
    }
  }

  SparseMatrix release() {
    SparseMatrix result;
    result.swap(matrix_);
    return result;
  }

 private:
  // Of every block column: the first rows of the blocks below the diagonal, ascending.
  std::vector<std::vector<long>> blocks_below(const std::vector<GluedEdge>& edges) const {
    std::vector<std::vector<long>> below(unknowns_.order.size());
    for (const auto& [i, j, t] : edges) {
      const auto [column, row] = std::minmax(unknowns_.first[i], unknowns_.first[j]);
      if (column >= 0 && column < row) below[column / 2].push_back(row);
    }
    for (std::vector<long>& rows : below) {
      std::sort(rows.begin(), rows.end());
      rows.erase(std::unique(rows.begin(), rows.end()), rows.end());
    }
    return below;
  }

  const Unknowns& unknowns_;
  SparseMatrix matrix_;
};

// A factor of the form, or, where rounding leaves it no longer positive, of the form with a small share of
// its diagonal added: enough for a preconditioner. In limbs whose edges are shorter than doubles tell apart,
// frames of neighbours do not agree.
LeadingFactor eliminate_strengthened(SparseMatrix form, const Unknowns& unknowns, Backend backend) {
  for (const double share : {1e-13, 1e-11, 1e-9}) {
    try {
      return eliminate<double>(form, backend, 0).factor;
    } catch (const NotPositiveDefinite&) {
      for (long column = 0; column < form.cols(); ++column)
        form.valuePtr()[form.outerIndexPtr()[column]] *= 1 + share;
    }
  }
  return eliminate_laplacian(form, unknowns, backend);
}

}  // namespace

TangentSystem::TangentSystem(Space space, const Points& x)
    : space_(space), x_(x), frames_(static_cast<std::size_t>(x.rows())) {
  parallel_ranges(static_cast<int>(x.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v) frames_[v] = space_.to_origin(x.row(v)).inverse_matrix().leftCols<2>();
  });
}

TangentSystem::TangentSystem(const TangentProblem& problem, const Points& x)
    : TangentSystem(problem.boundary.space, x) {
  Factored factored;
  factored.unknowns = number_unknowns(problem.dissection.order, tangent_unknowns(problem.boundary));
  factored.is_stiff = problem.w.size() > 0 && problem.w.maxCoeff() > stiff_weight;
  form_ = assemble_form(problem, x, factored);
  try {
    if (factored.unknowns.total > 0) factored.factor = eliminate<double>(*form_, problem.backend, 0).factor;
  } catch (const NotPositiveDefinite&) {
    factored.is_exact = false;
    form_ = assemble_form(problem, x, factored);
    factored.factor = eliminate_strengthened(*form_, factored.unknowns, problem.backend);
  }
  factored_ = std::make_shared<Factored>(std::move(factored));
}

TangentSystem TangentSystem::moved_to(const Points& x) const {
  TangentSystem result = *this;
  result.x_ = x;
  parallel_ranges(static_cast<int>(x.rows()), [&](int begin, int end) {
    for (int v = begin; v < end; ++v)
      for (int a = 0; a < 2; ++a)
        result.frames_[v].col(a) = space_.moved_along(frames_[v].col(a), x_.row(v), x.row(v));
  });
  return result;
}

TangentSystem TangentSystem::beside(const TangentProblem& problem, const Points& x) const {
  TangentSystem result = moved_to(x);
  result.form_ = result.assemble_form(problem, x, *factored_);
  return result;
}

std::shared_ptr<const SparseMatrix> TangentSystem::assemble_form(const TangentProblem& problem,
                                                                 const Points& x,
                                                                 const Factored& factored) const {
  const std::vector<GluedEdge>& edges = problem.glued.edges;
  const Vector3 metric = problem.boundary.space.metric();
  const auto lowered = [&](int v) -> Frame { return metric.asDiagonal() * frames_[v]; };
  std::vector<double> sense;
  for (const Isometry& g : problem.glued.transforms) sense.push_back(g.reverses_orientation() ? -1 : 1);
  std::vector<EdgeHessian> hessians(edges.size());
  visit_curvature(problem.boundary.space, [&]<int k>(Curvature<k> curvature) {
    parallel_ranges(static_cast<int>(edges.size()), [&](int begin, int end) {
      for (int e = begin; e < end; ++e) {
        const auto& [i, j, t] = edges[e];
        const Isometry& g = problem.glued.transforms[t];
        const Vector3 p = x.row(i), x_j = x.row(j), q = g * x_j, seen = g.inverse_matrix() * p;
        const auto d = curvature.distance(p, q);
        const NormalFactors factors =
            factored.is_exact ? normal_factors<k>(d.squared, d.over_sn) : NormalFactors();
        const Row2 e_p = unit_in_frame(curvature.tangent(p, q - p), lowered(i)),
                   e_q = -unit_in_frame(curvature.tangent(x_j, seen - x_j), lowered(j));
        const EdgeHessian one =
            hessian_along({e_p, e_q, turned_left(e_p), sense[t] * turned_left(e_q)}, factors);
        const double w = 2 * problem.w[e];
        hessians[e] = {w * one.ii, w * one.jj, w * one.ij};
      }
    });
  });
  BlockMatrix matrix(factored.unknowns, edges);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const auto& [i, j, t] = edges[e];
    matrix.add(i, i, hessians[e].ii);
    matrix.add(j, j, hessians[e].jj);
    matrix.add(i, j, hessians[e].ij);
    matrix.add(j, i, hessians[e].ij.transpose());
  }
  return std::make_shared<SparseMatrix>(matrix.release());
}

Points TangentSystem::packed(const std::vector<Points>& gradients, std::size_t first) const {
  const Unknowns& unknowns = factored_->unknowns;
  Points b = Points::Zero(unknowns.total, 3);
  for (std::size_t c = 0; c < std::min<std::size_t>(3, gradients.size() - first); ++c)
    for (const int v : unknowns.order)
      b.block<2, 1>(unknowns.first[v], static_cast<Eigen::Index>(c)) =
          frames_[v].transpose() * gradients[first + c].row(v).transpose();
  return b;
}

Points TangentSystem::unpacked(const Points& y, Eigen::Index column) const {
  const Unknowns& unknowns = factored_->unknowns;
  Points result = Points::Zero(static_cast<Eigen::Index>(frames_.size()), 3);
  for (const int v : unknowns.order)
    result.row(v) = (frames_[v] * y.block<2, 1>(unknowns.first[v], column)).transpose();
  return result;
}

template <int count>
SingleColumns<count> TangentSystem::solved(const SingleColumns<count>& b) const {
  SingleColumns<count> y = b;
  factored_->factor.template forward<count>(y);
  factored_->factor.template backward<count>(y);
  return y;
}

SingleVector TangentSystem::refined(const SingleVector& b, const SingleVector& y) const {
  const Eigen::VectorXd image = form_->selfadjointView<Eigen::Lower>() * Eigen::VectorXd(y.cast<double>());
  return y + solved<1>((b.cast<double>() - image).cast<float>());
}

Points TangentSystem::precondition(const Points& gradient) const {
  const Unknowns& unknowns = factored_->unknowns;
  SingleVector b(unknowns.total);
  for (const int v : unknowns.order)
    b.segment<2>(unknowns.first[v]) = (frames_[v].transpose() * gradient.row(v).transpose()).cast<float>();
  SingleVector y = solved<1>(b);
  if (factored_->is_stiff) y = refined(b, y);
  Points result = Points::Zero(gradient.rows(), 3);
  for (const int v : unknowns.order)
    result.row(v) = (frames_[v] * y.segment<2>(unknowns.first[v]).cast<double>()).transpose();
  return result;
}

// M. R. Hestenes, E. Stiefel, "Methods of conjugate gradients for solving linear systems", J. Res. Nat. Bur.
// Standards 49 (1952), preconditioned, each of the three columns for itself.
Points TangentSystem::conjugate_gradients(const Points& b) const {
  constexpr int most_rounds = 60;
  constexpr double tolerance = 1e-5;
  const auto products = [](const Points& x, const Points& y) -> Eigen::RowVector3d {
    return x.cwiseProduct(y).colwise().sum();
  };
  const auto preconditioned = [&](const Points& r) -> Points {
    const Eigen::RowVector3d size =
        r.cwiseAbs().colwise().maxCoeff().cwiseMax(1e-300);  // float's range is narrow
    const Points scaled = r * size.cwiseInverse().asDiagonal();
    return Points(solved<3>(scaled.cast<float>()).cast<double>()) * size.asDiagonal();
  };
  Points y = Points::Zero(b.rows(), 3), r = b, z = preconditioned(r), p = z;
  Eigen::RowVector3d rz = products(r, z);
  const Eigen::RowVector3d wanted = tolerance * tolerance * rz.cwiseAbs();
  for (int round = 0; round < most_rounds && (rz.array() > wanted.array()).any(); ++round) {
    const Points image = form_->selfadjointView<Eigen::Lower>() * p;
    const Eigen::RowVector3d curvature = products(p, image);
    Eigen::RowVector3d step = Eigen::RowVector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (curvature[c] > 0 && rz[c] > wanted[c]) step[c] = rz[c] / curvature[c];
    y += p * step.asDiagonal();
    r -= image * step.asDiagonal();
    z = preconditioned(r);
    const Eigen::RowVector3d next = products(r, z);
    Eigen::RowVector3d share = Eigen::RowVector3d::Zero();
    for (int c = 0; c < 3; ++c)
      if (rz[c] > 0) share[c] = next[c] / rz[c];
    p = z + p * share.asDiagonal();
    rz = next;
  }
  return y;
}

std::vector<Points> TangentSystem::solve(const std::vector<Points>& gradients) const {
  std::vector<Points> results;
  results.reserve(gradients.size());
  for (std::size_t first = 0; first < gradients.size(); first += 3) {
    const Points y = conjugate_gradients(packed(gradients, first));
    for (std::size_t c = first; c < std::min(first + 3, gradients.size()); ++c)
      results.push_back(unpacked(y, static_cast<Eigen::Index>(c - first)));
  }
  return results;
}

}  // namespace orbitutte
