// SPDX-License-Identifier: MIT
#include "orbitutte/solve/initial_embedding.h"

#include "orbitutte/geometry/stereographic_chart.h"
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

// Where the banks are too long to be settled: they stay on the arcs, and the rest is a planar Tutte embedding
// of the tile's orthographic projection from its centroid, lifted back to the space.
Points lifted_from_arcs(const Points& on_arcs, const CutMesh& cut, const Tile& tile,
                        const LaplacianSolver& laplacian) {
  const Space space = tile.space();
  const Isometry to_origin = space.to_origin(tile.centroid());
  Points result = to_origin.on_rows(laplacian.extend_harmonically(on_arcs));
  for (Eigen::Index v = 0; v < result.rows(); ++v) result.row(v) = space.lift(result(v, 0), result(v, 1));
  result = to_origin.inverse().on_rows(result);
  for (const int v : cut.boundary)
    if (v < result.rows()) result.row(v) = on_arcs.row(v);  // also where the tile reaches below the equator
  return result;
}

}  // namespace

Points initial_embedding(const Surface& surface, const CutMesh& cut, const Tile& tile,
                         const BoundaryConditions& boundary, const LaplacianSolver& laplacian) {
  const int n = boundary.vertex_count();
  const Points on_arcs = boundary_on_arcs(surface, cut, tile, boundary).topRows(n);
  const StereographicChart chart(tile.space(), tile.centroid());
  Points result = laplacian.settle(on_arcs, chart);
  if (result.rows() < n) {
    result = lifted_from_arcs(on_arcs, cut, tile, laplacian);
  } else {
    parallel_ranges(n, [&](int begin, int end) {
      for (int v = begin; v < end; ++v) result.row(v) = chart.point(result.row(v));
    });
  }
  boundary.make_feasible(result);
  return result;
}

}  // namespace orbitutte
