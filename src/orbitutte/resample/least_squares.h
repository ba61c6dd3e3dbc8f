// SPDX-License-Identifier: MIT
// Values on a grid of which those of the surface are made again.
// Conjugate gradients for least squares (CGLS): M. R. Hestenes, E. Stiefel, "Methods of conjugate gradients
// for solving linear systems", 1952, section 10; Å. Björck, "Numerical Methods for Least Squares Problems",
// 1996, algorithm 7.4.1.
#pragma once

#include "orbitutte/resample/sparse_table.h"

namespace orbitutte {

/// When the iteration ends.
struct LeastSquaresOptions {
  /// More steps come nearer to values that change from vertex to vertex, but by values on the grid that
  /// swing far beyond them: to stop early is what keeps these small.
  int max_iterations = 10;

  /// |P^T (f - P g)| <= tolerance |P^T (f - P Q f)|, for each map by itself.
  double tolerance = 1e-6;
};

/// With P, the table from the grid to the surface (n x k), and Q, that to the grid (k x n), the values g of
/// the grid with
///
///     |f - P g| least, and of these the nearest to Q f,
///
/// as far as some steps from Q f come, for values f of the surface (n x maps): k x maps. Where the grid has
/// more points than the surface has vertices, P g is nearly f; where it has fewer, it is as near as can be.
/// Constants stay what they are.
/// Vertices without a value (NaN), and those for which Q f has none, are left out of the sum; points where
/// Q f has no value have none. Throws ArgumentError if the tables are not of one surface and grid, or if
/// there are not as many values as vertices.
Eigen::MatrixXd least_squares_values(const SparseTable& to_surface, const SparseTable& to_grid,
                                     const Eigen::MatrixXd& values, const LeastSquaresOptions& options = {});

}  // namespace orbitutte
