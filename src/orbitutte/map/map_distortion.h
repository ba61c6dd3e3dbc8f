// SPDX-License-Identifier: MIT
// How much a map between two surfaces stretches.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

/// Of a map that is linear on triangles, both surfaces scaled to area one. With the singular values s, t of
/// the map on a triangle, the symmetric Dirichlet energy is (s^2 + t^2 + s^-2 + t^-2)/4: 1 for isometries.
struct MapDistortion {
  /// Weighted by the area of A.
  struct SymmetricDirichlet {
    double mean = 0, median = 0, percentile_90 = 0;
  } symmetric_dirichlet;

  /// The part of A's area that is shrunk or grown by a factor of at most four: 1/4 <= s t <= 4.
  double within_4 = 0;

  /// The part of A's area on triangles that are degenerate on A or on B, which are left out of everything
  /// else.
  double degenerate = 0;
};

/// triangles: T x 3; from and to: the positions on A and on B (n x 3 each).
MapDistortion measure_map(const Triangles& triangles, const Points& from, const Points& to);

}  // namespace orbitutte
