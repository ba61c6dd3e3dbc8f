// SPDX-License-Identifier: MIT
#include "orbitutte/solve/initial_embedding.h"

#include <Eigen/Geometry>
#include <cmath>

namespace orbitutte {
namespace {

// The fraction of the path's length at each vertex, from 0 to 1. A thousandth is shared equally, so that no
// two vertices fall together where the source has edges of length zero.
std::vector<double> arc_length_fractions(const std::vector<int>& side, const Mesh& mesh,
                                         const std::vector<int>& source) {
  std::vector<double> at = {0};
  for (std::size_t k = 1; k < side.size(); ++k)
    at.push_back(at.back() + (mesh.V.row(source[side[k]]) - mesh.V.row(source[side[k - 1]])).norm());
  const double total = at.back(), steps = static_cast<double>(side.size() - 1);
  for (std::size_t k = 0; k < at.size(); ++k) {
    const double equal = static_cast<double>(k) / steps;
    at[k] = total > 0 ? 0.999 * at[k] / total + 0.001 * equal : equal;
  }
  return at;
}

// Each side's vertices on its arc. Both sides of a seam have the same fractions, so the positions agree
// across it.
Points boundary_on_arcs(const Mesh& mesh, const CutMesh& cut, const Tile& tile,
                        const BoundaryConditions& boundary) {
  Points result = Points::Zero(cut.vertex_count(), 3);
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    const std::vector<int>& side = boundary.sides[s];
    const std::vector<double> at = arc_length_fractions(side, mesh, cut.source_vertex);
    for (std::size_t k = 0; k + 1 < side.size(); ++k)
      result.row(side[k]) = tile.sides[s].point(at[k] * tile.sides[s].length);
  }
  return result;
}

}  // namespace

Points initial_embedding(const Mesh& mesh, const CutMesh& cut, const Tile& tile,
                         const BoundaryConditions& boundary, const LaplacianSolver& laplacian) {
  const Matrix3 to_pole =
      Eigen::Quaterniond::FromTwoVectors(tile.centroid(), Vector3::UnitZ()).toRotationMatrix();
  const Eigen::Index n = boundary.held.rows();
  const Points on_arcs = boundary_on_arcs(mesh, cut, tile, boundary).topRows(n);
  Points lifted = laplacian.extend_harmonically(on_arcs) * to_pole.transpose();
  lifted.col(2) = (1 - lifted.leftCols<2>().rowwise().squaredNorm().array()).cwiseMax(0).sqrt();
  Points result = lifted * to_pole;
  for (const int v : cut.boundary)
    if (v < n) result.row(v) = on_arcs.row(v);  // also where the tile reaches below the equator's rounding
  for (Eigen::Index v = 0; v < n; ++v) {
    const Basis& room = boundary.basis(static_cast<int>(v));
    if (room.cols() == 0) result.row(v) = boundary.held.row(v);
    if (room.cols() == 2) result.row(v) = room * (room.transpose() * result.row(v).transpose());
  }
  return result.rowwise().normalized();
}

}  // namespace orbitutte
