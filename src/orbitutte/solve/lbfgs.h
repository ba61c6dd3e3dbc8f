// SPDX-License-Identifier: MIT
// Preconditioned L-BFGS on the sphere (algorithm 1, with the corrections listed in docs/deviations.md).
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

enum class Termination { converged, max_iterations, line_search_failed };

/// "converged", "max_iterations" or "line_search_failed".
std::string name(Termination termination);

/// One row of the history: the state after an iteration (the first row: the start).
struct Iteration {
  double energy = 0;
  double gradient_norm = 0;  ///< infinity norm of the feasible, tangential gradient
  double step = 0;           ///< infinity norm of the displacement that led here, radians
};

/// Called after every iteration; returning false cancels (the optimiser throws Cancelled).
using IterationCallback = std::function<bool(int iteration, const Iteration&)>;

/// When to stop.
struct LbfgsOptions {
  /// Converged when |grad_i E| <= max(tolerance, its rounding floor) at every vertex, and the next
  /// quasi-Newton step would move no vertex by more than max(tolerance, 1e-12) radians.
  double tolerance = 1e-9;
  int max_iterations = 2000;
  int memory = 10;  ///< pairs of steps and gradient differences kept
  IterationCallback callback;
};

/// Where the optimiser ended, and why.
struct Minimum {
  Points positions;  ///< n x 3, unit
  double energy = 0;
  double gradient_norm = 0;
  int iterations = 0;
  int evaluations = 0;
  Termination termination = Termination::converged;
  std::vector<Iteration> history;
};

/// Minimises E from unit positions. Throws ArgumentError for options out of range, and Cancelled.
Minimum minimize(const DirichletEnergy& energy, const LaplacianSolver& laplacian, const Points& start,
                 const LbfgsOptions& options = {});

}  // namespace orbitutte
