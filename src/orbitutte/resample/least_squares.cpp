// SPDX-License-Identifier: MIT
#include "orbitutte/resample/least_squares.h"

#include <fmt/format.h>

#include <cmath>

#include "orbitutte/errors.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using Eigen::VectorXd;

void require_one_grid(const SparseTable& to_surface, const SparseTable& to_grid) {
  if (to_surface.rows() != to_grid.columns || to_surface.columns != to_grid.rows())
    throw ArgumentError(
        fmt::format("one table is {} x {}, the other {} x {}; they must be of one surface and one grid",
                    to_surface.rows(), to_surface.columns, to_grid.rows(), to_grid.columns));
}

// A x; zero where a row is empty.
VectorXd times(const SparseTable& A, const VectorXd& x) {
  VectorXd result(A.rows());
  parallel_ranges(A.rows(), [&](int begin, int end) {
    for (int r = begin; r < end; ++r) {
      double sum = 0;
      for (int k = A.start[r]; k < A.start[r + 1]; ++k) sum += A.weight[k] * x[A.index[k]];
      result[r] = sum;
    }
  });
  return result;
}

// The equations P g = f of one map, those left out that have no value.
struct Equations {
  const SparseTable &P, &transposed;
  VectorXd counts;  // 1 or 0

  VectorXd rows(const VectorXd& g) const { return times(P, g).cwiseProduct(counts); }
  VectorXd columns(const VectorXd& r) const { return times(transposed, r); }
};

// Improves g. `residual`: f - P g.
void iterate(const Equations& equations, VectorXd residual, const LeastSquaresOptions& options, VectorXd& g) {
  VectorXd gradient = equations.columns(residual), direction = gradient;
  double size = gradient.squaredNorm();
  const double end = options.tolerance * options.tolerance * size;
  for (int k = 0; k < options.max_iterations && size > end; ++k) {
    const VectorXd change = equations.rows(direction);
    const double step = size / change.squaredNorm();
    g += step * direction;
    residual -= step * change;
    gradient = equations.columns(residual);
    const double next = gradient.squaredNorm();
    direction = gradient + next / size * direction;
    size = next;
  }
}

}  // namespace

Eigen::MatrixXd least_squares_values(const SparseTable& to_surface, const SparseTable& to_grid,
                                     const Eigen::MatrixXd& values, const LeastSquaresOptions& options) {
  require_one_grid(to_surface, to_grid);
  Eigen::MatrixXd result = apply(to_grid, values);
  const SparseTable transpose = transposed(to_surface);
  for (Eigen::Index map = 0; map < values.cols(); ++map) {
    VectorXd g = result.col(map), residual = values.col(map) - apply(to_surface, g);
    const VectorXd counts = residual.unaryExpr([](double value) { return std::isfinite(value) ? 1.0 : 0.0; });
    residual = (counts.array() > 0).select(residual, 0);
    iterate({to_surface, transpose, counts}, residual, options, g);
    result.col(map) = g;
  }
  return result;
}

}  // namespace orbitutte
