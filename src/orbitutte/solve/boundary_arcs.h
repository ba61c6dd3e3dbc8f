// SPDX-License-Identifier: MIT
// Where the vertices of a side stand on its great arc.
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/options.h"
#include "orbitutte/solve/boundary_conditions.h"

namespace orbitutte {

/// The fraction of the arc at each vertex of a side, from 0 to 1, strictly ascending. By arc length, a
/// thousandth is shared equally, so that no two vertices fall together where the source has edges of length
/// zero. side: cut vertices; source: n_cut, their input
/// vertices.
std::vector<double> arc_fractions(const std::vector<int>& side, const Surface& surface,
                                  const std::vector<int>& source, Spread spread);

/// Holds the vertices of the tile's held sides on their arcs (theorem 1), where `boundary` has held the
/// corners alone.
void hold_sides(const Surface& surface, const CutMesh& cut, const Tile& tile, Spread spread,
                BoundaryConditions& boundary);

}  // namespace orbitutte
