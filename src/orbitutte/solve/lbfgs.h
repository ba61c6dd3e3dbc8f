// SPDX-License-Identifier: MIT
// Preconditioned L-BFGS (algorithm 1, with the corrections listed in docs/deviations.md).
#pragma once

#include <functional>

#include "orbitutte/minimum.h"
#include "orbitutte/solve/dirichlet_energy.h"
#include "orbitutte/solve/preconditioner.h"

namespace orbitutte {

/// Called after every iteration; returning false cancels (the optimiser throws Cancelled).
using IterationCallback = std::function<bool(int iteration, const Iteration&)>;

/// When to stop.
struct LbfgsOptions {
  /// Converged when |grad_i E| <= max(tolerance, its rounding floor) at every vertex, and the next
  /// quasi-Newton step would move no vertex by more than max(tolerance, 1e-12) radians; or, if the rounding
  /// floor of some vertex is above the tolerance, would change the energy by less than its rounding hides.
  double tolerance = 1e-9;
  int max_iterations = 2000;
  /// Pairs of steps and gradient differences kept.
  int memory = 10;
  IterationCallback callback;
};

/// Minimises E from points of its space. Throws ArgumentError for options out of range, and Cancelled.
Minimum minimize(const DirichletEnergy& energy, const Preconditioner& preconditioner, Points start,
                 const LbfgsOptions& options = {});

}  // namespace orbitutte
