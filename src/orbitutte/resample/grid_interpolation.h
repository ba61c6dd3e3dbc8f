// SPDX-License-Identifier: MIT
// Values between the points of a grid. Private to resample/.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/resample/grid.h"
#include "orbitutte/resample/sparse_table.h"

namespace orbitutte {

/// How values at any points come from values at the points of a grid: linear in a triangle of the grid, or in
/// row and column of an image; of HEALPix as Healpix::stencil has it.
class GridInterpolation {
 public:
  /// Refers to the grid.
  explicit GridInterpolation(const Grid& grid);
  ~GridInterpolation();

  /// One for each point (m x 3, in the canonical frame of the target); empty where nothing is found.
  std::vector<Stencil> stencils(const Points& points) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orbitutte
