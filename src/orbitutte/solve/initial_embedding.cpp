// SPDX-License-Identifier: MIT
#include "orbitutte/solve/initial_embedding.h"

#include "orbitutte/parallel.h"
#include "orbitutte/solve/boundary_arcs.h"

namespace orbitutte {
namespace {

// Each side's vertices on its arc. Both sides of a seam have the same fractions, so the positions agree
// across it. What is held stands where it is held.
Points boundary_on_arcs(const Surface& surface, const CutMesh& cut, const Tile& tile,
                        const BoundaryConditions& boundary) {
  Points result = Points::Zero(cut.vertex_count(), 3);
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    const std::vector<int>& side = boundary.sides[s];
    const std::vector<double> at = arc_fractions(side, surface, cut.source_vertex, Spread::arc_length);
    for (std::size_t k = 0; k + 1 < side.size(); ++k)
      result.row(side[k]) = tile.sides[s].point(at[k] * tile.sides[s].length);
  }
  for (const auto& [v, point] : boundary.held) result.row(v) = point;
  return result;
}

}  // namespace

Points initial_embedding(const Surface& surface, const CutMesh& cut, const Tile& tile,
                         const BoundaryConditions& boundary, const LaplacianSolver& laplacian) {
  const Space space = tile.space();
  const Isometry to_origin = space.to_origin(tile.centroid());
  const int n = boundary.vertex_count();
  const Points on_arcs = boundary_on_arcs(surface, cut, tile, boundary).topRows(n);
  Points result = to_origin.on_rows(laplacian.extend_harmonically(on_arcs));
  parallel_ranges(n, [&](int begin, int end) {
    for (int v = begin; v < end; ++v) result.row(v) = space.lift(result(v, 0), result(v, 1));
  });
  result = to_origin.inverse().on_rows(result);
  for (const int v : cut.boundary)
    if (v < n) result.row(v) = on_arcs.row(v);  // also where the tile reaches below the equator's rounding
  boundary.make_feasible(result);
  return result;
}

}  // namespace orbitutte
