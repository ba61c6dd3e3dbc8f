// SPDX-License-Identifier: MIT
#include "orbitutte/solve/placement.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

#include "orbitutte/solve/flipped_edges.h"
#include "orbitutte/solve/frame.h"
#include "orbitutte/solve/initial_embedding.h"
#include "orbitutte/solve/planar_minimum.h"

namespace orbitutte {
namespace {

// Cones that lie opposite to each other need more than one edge between them: every arc of length pi is as
// short as any other.
void require_apart(const GluedEdges& glued, const BoundaryConditions& boundary, const Orbifold& orbifold) {
  for (const auto& [i, j, t] : glued.edges) {
    if (boundary.basis(i).cols() > 0 || boundary.basis(j).cols() > 0) continue;
    const Vector3 p = boundary.held.row(i), q = glued.transforms[t] * boundary.held.row(j).transpose();
    if ((p + q).norm() < 1e-9)
      throw MeshError(
          fmt::format("the marked vertices {} and {} are joined by an edge, but {} puts them at opposite "
                      "points of the sphere; mark "
                      "vertices that are further apart, or split the edge",
                      i, j, orbifold.signature));
  }
}

// Where a rotation about the axis changes nothing, turns the map so that the vertex nearest to the equator
// has longitude 0.
void fix_gauge(const Tile& tile, Points& positions) {
  Vector3 axis;
  if (!free_rotation_axis(tile, axis)) return;
  Eigen::Index vertex = 0;
  (positions * axis).cwiseAbs().minCoeff(&vertex);
  const Vector3 forward = tile.sides.front().direction, left = axis.cross(forward);
  const Vector3 p = positions.row(vertex);
  const double longitude = std::atan2(p.dot(left), p.dot(forward));
  positions = positions * Eigen::AngleAxisd(-longitude, axis).toRotationMatrix().transpose();
  positions.rowwise().normalize();
}

// Turns the map where the tile is free to turn: to where small spots are resolved.
void resolve(const GluingProblem& problem, const SphericalEnergy& energy, Placement& placed) {
  Points& positions = placed.minimum.positions;
  const std::optional<Matrix3> frame =
      stays_put(placed.tile) ? std::nullopt : resolving_frame(energy, positions);
  if (!frame) return;
  placed.tile = rotated(placed.tile, *frame);
  placed.boundary = glue(problem.cut, placed.tile, problem.orbifold);
  const SphericalEnergy there(glued_along(problem, placed.boundary), problem.weights, placed.boundary);
  positions = settle_in_frame(positions, *frame, there, placed.boundary);
}

Placement minimum_on_sphere(const GluingProblem& problem, const LbfgsOptions& options, Stages& stage) {
  const GluedEdges glued = glued_along(problem, problem.boundary);
  require_apart(glued, problem.boundary, problem.orbifold);
  const SphericalEnergy energy(glued, problem.weights, problem.boundary);  // (2)
  const LaplacianSolver laplacian = stage("factorize", [&] {
    return LaplacianSolver(problem.cut, glued, problem.weights, problem.boundary, problem.laplacian);
  });
  const Points start = stage("initialize", [&] {  // appendix B
    return initial_embedding(problem.surface, problem.cut, problem.tile, problem.boundary, laplacian);
  });
  LbfgsOptions lbfgs = options;
  lbfgs.callback = [&](int iteration, const Iteration& state) {
    stage.tell({"optimize", iteration, state.energy, state.gradient_norm});
    return true;
  };
  Placement placed = {{}, problem.tile, problem.boundary};
  placed.minimum =
      stage("optimize", [&] { return minimize(energy, laplacian, start, lbfgs); });  // algorithm 1
  fix_gauge(placed.tile, placed.minimum.positions);
  resolve(problem, energy, placed);
  return placed;
}

Placement minimum_in_plane(const GluingProblem& problem, Stages& stage) {
  const GluedEdges glued = glued_along(problem, problem.boundary);
  Placement placed = {{}, problem.tile, problem.boundary};
  stage("optimize", [&] {
    PlanarMinimum solution =
        planar_minimum(problem.cut, glued, problem.weights, problem.boundary, problem.laplacian);
    placed.minimum.positions = std::move(solution.positions);
    placed.minimum.energy = solution.energy;
    placed.minimum.gradient_norm = solution.gradient_norm;
    placed.minimum.iterations = placed.minimum.evaluations = 1;
    placed.minimum.termination = Termination::converged;  // a linear system has been solved
    placed.minimum.history = {{solution.energy, solution.gradient_norm, 0}};
  });
  return placed;
}

}  // namespace

GluedEdges glued_along(const GluingProblem& problem, const BoundaryConditions& boundary) {
  const IntrinsicTriangulation* triangulation = problem.weights.triangulation.get();
  return triangulation ? flipped_edges(problem.surface, *triangulation, problem.cut, boundary)
                       : glued_edges(problem.cut, problem.surface.connectivity, boundary);
}

BoundaryConditions boundary_conditions(const Surface& surface, const CutMesh& cut, const Tile& tile,
                                       const Orbifold& orbifold, Spread spread) {
  BoundaryConditions boundary = glue(cut, tile, orbifold);
  hold_sides(surface, cut, tile, spread, boundary);
  return boundary;
}

Placement place(const GluingProblem& problem, const LbfgsOptions& options, Stages& stage) {
  return problem.tile.geometry() == Geometry::spherical ? minimum_on_sphere(problem, options, stage)
                                                        : minimum_in_plane(problem, stage);
}

}  // namespace orbitutte
