// SPDX-License-Identifier: MIT
// Where the optimiser ended, and why.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/types.h"

namespace orbitutte {

enum class Termination { converged, max_iterations, line_search_failed };

/// Its names.
template <>
struct NameTable<Termination> {
  static constexpr NamedValue<Termination> rows[] = {{Termination::converged, "converged"},
                                                     {Termination::max_iterations, "max_iterations"},
                                                     {Termination::line_search_failed, "line_search_failed"}};
};

/// One row of the history: the state after an iteration (the first row: the start).
struct Iteration {
  double energy = 0;
  /// The infinity norm of the feasible, tangential gradient.
  double gradient_norm = 0;
  /// The infinity norm of the displacement that led here, radians.
  double step = 0;
};

/// Where the optimiser ended, and how it came there.
struct Minimum {
  /// n x 3, points of the space.
  Points positions;
  double energy = 0;
  double gradient_norm = 0;
  int iterations = 0;
  int evaluations = 0;
  Termination termination = Termination::converged;
  std::vector<Iteration> history;

  /// If the shape of the tile is found on the way: a row for each tile, with the largest derivative of the
  /// energy by a unit step of the shape for `gradient_norm`, and the length of the step.
  std::vector<Iteration> shapes = {};
};

}  // namespace orbitutte
