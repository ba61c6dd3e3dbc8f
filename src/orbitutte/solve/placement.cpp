// SPDX-License-Identifier: MIT
#include "orbitutte/solve/placement.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>
#include <utility>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/solve/conformal_map.h"
#include "orbitutte/solve/curved_map.h"
#include "orbitutte/solve/flipped_edges.h"
#include "orbitutte/solve/initial_embedding.h"

namespace orbitutte {
namespace {

// Cones that lie opposite to each other need more than one edge between them: every arc of length pi is as
// short as any other.
void require_apart(const GluedEdges& glued, const BoundaryConditions& boundary, const Target& target) {
  for (const auto& [i, j, t] : glued.edges) {
    if (boundary.basis(i).cols() > 0 || boundary.basis(j).cols() > 0) continue;
    const Vector3 p = boundary.held_at(i), q = glued.transforms[t] * boundary.held_at(j);
    if ((p + q).norm() < 1e-9)
      throw MeshError(
          fmt::format("the marked vertices {} and {} are joined by an edge, but {} puts them at opposite "
                      "points of the sphere; mark "
                      "vertices that are further apart, or split the edge",
                      i, j, target.signature));
  }
}

// Of a point and its images across the tile's sides, the one that lies highest: the same for every cut.
Vector3 highest_image(const Vector3& point, const Tile& tile) {
  Vector3 highest = point;
  for (const TileSide& side : tile.sides)
    if (const Vector3 image = side.transform * point; image.z() > highest.z() + 1e-9) highest = image;
  return highest;
}

// The first vertex that may move and lies far from the poles; the first vertex if there is none.
int vertex_far_from_poles(const BoundaryConditions& boundary, const Points& positions) {
  for (Eigen::Index v = 0; v < positions.rows(); ++v)
    if (boundary.basis_of[v] != held_in_place && std::abs(positions(v, 2)) < 0.9) return static_cast<int>(v);
  return 0;
}

// Moves the map, the tile and its gluing.
void move(const GluingProblem& problem, const Isometry& isometry, Placement& placed) {
  placed.tile = moved_tile(placed.tile, isometry);
  placed.boundary = glue(problem.cut, placed.tile, problem.target);
}

// Of the first face far from the equator, counterclockwise as the mesh has it: does it lie below the equator?
bool lies_below(const GluingProblem& problem, const Placement& placed) {
  const CutMesh& cut = problem.cut;
  const Points all = placed.boundary.spread(placed.minimum.positions, cut.source_vertex);
  for (Eigen::Index f = 0; f < cut.F.rows(); ++f) {
    const double height = (all(cut.F(f, 0), 2) + all(cut.F(f, 1), 2) + all(cut.F(f, 2), 2)) / 3;
    if (std::abs(height) > 0.5) return cut.turned[f] ? height > 0 : height < 0;
  }
  return false;
}

// Where the surface has no orientation (Nx), the half turn that exchanges the poles takes a map to another
// that is as good, and the cut decides which of them is found. It is applied so that both cuts give the same.
void fix_poles(const GluingProblem& problem, Placement& placed) {
  if (problem.cut.turned.empty() || !lies_below(problem, placed)) return;
  const Isometry half_turn = problem.target.space.rotation(Vector3::UnitX(), std::numbers::pi);
  move(problem, half_turn, placed);
  placed.minimum.positions = half_turn.on_rows(placed.minimum.positions);
  placed.boundary.make_feasible(placed.minimum.positions);
}

// The point that comes to have longitude 0, where the direction of the map is a choice: the second mark, or
// any vertex.
Vector3 point_to_turn(const GluingProblem& problem, const Placement& placed) {
  const Points& positions = placed.minimum.positions;
  if (problem.target.has_free_tile) return point_towards_x(problem.target, problem.cut, positions);
  return highest_image(positions.row(vertex_far_from_poles(placed.boundary, positions)), placed.tile);
}

// Where a rotation about (0, 0, 1) changes nothing, turns the map so that a vertex has longitude 0.
void fix_rotation(const GluingProblem& problem, Placement& placed) {
  if (!problem.target.is_free_to_rotate && !problem.target.has_free_tile) return;
  Points& positions = placed.minimum.positions;
  const Vector3 p = point_to_turn(problem, placed);
  const Isometry turn = problem.target.space.rotation(Space::origin(), -std::atan2(p.y(), p.x()));
  move(problem, turn, placed);
  positions = turn.on_rows(positions);
  placed.boundary.make_feasible(positions);
}

DirichletEnergy energy_along(const GluingProblem& problem, const BoundaryConditions& boundary) {
  return {glued_along(problem, boundary), problem.weights, boundary};
}

// The tile, its gluing and the positions from which the optimiser starts (appendix B).
Placement start_on_tile(const GluingProblem& problem, const LaplacianSolver& laplacian) {
  Placement placed = {{}, problem.tile, problem.boundary, {}};
  placed.minimum.positions =
      initial_embedding(problem.surface, problem.cut, problem.tile, problem.boundary, laplacian);
  return placed;
}

// The same with the tile that has the surface's own shape.
Placement start_on_free_tile(const GluingProblem& problem, const LaplacianSolver& laplacian) {
  Placement placed;
  placed.minimum.positions = conformal_map(problem, laplacian);
  placed.tile = tile_through(problem.target, problem.cut, placed.minimum.positions);
  placed.boundary = glue(problem.cut, placed.tile, problem.target);
  placed.boundary.make_feasible(placed.minimum.positions);
  return placed;
}

// The map onto a curved tile that has the surface's own shape. It stays where it was found, around (0, 0, 1),
// since hyperbolic coordinates lose digits with the distance from there.
Placement place_on_curved_tile(const GluingProblem& problem, const LbfgsOptions& options, Stages& stage) {
  Placement placed;
  placed.minimum = stage("optimize", [&] { return curved_map(problem, options, stage); });
  Points& positions = placed.minimum.positions;
  positions.row(problem.cut.marks.front()) = closing_position(problem.target, problem.cut, positions);
  placed.tile = tile_through(problem.target, problem.cut, positions);
  placed.boundary = glue(problem.cut, placed.tile, problem.target);
  placed.boundary.make_feasible(positions);
  placed.frame = frame_of_marks(problem, positions);
  return placed;
}

}  // namespace

Isometry frame_of_marks(const GluingProblem& problem, const Points& positions) {
  const Space space = problem.target.space;
  const Isometry to_origin = space.to_origin(positions.row(problem.cut.marks[0]));
  const Vector3 second = to_origin * Vector3(positions.row(problem.cut.marks[1]));
  return to_origin.inverse() * space.rotation(Space::origin(), std::atan2(second.y(), second.x()));
}

GluedEdges glued_along(const GluingProblem& problem, const BoundaryConditions& boundary) {
  const IntrinsicTriangulation* triangulation = problem.weights.triangulation.get();
  return triangulation ? flipped_edges(problem.surface, *triangulation, problem.cut, boundary)
                       : glued_edges(problem.cut, problem.surface.connectivity, boundary);
}

double energy_of(const GluingProblem& problem, const Placement& placed) {
  return energy_along(problem, placed.boundary).evaluate(placed.minimum.positions).energy;
}

BoundaryConditions boundary_conditions(const Surface& surface, const CutMesh& cut, const Tile& tile,
                                       const Target& target, Spread spread) {
  BoundaryConditions boundary = glue(cut, tile, target);
  hold_sides(surface, cut, tile, spread, boundary);
  return boundary;
}

Placement moved(const GluingProblem& problem, const Isometry& isometry, const Placement& placed) {
  Placement result = placed;
  move(problem, isometry, result);
  result.minimum.positions = isometry.on_rows(placed.minimum.positions);
  result.boundary.make_feasible(result.minimum.positions);
  result.frame = isometry * placed.frame;
  return result;
}

Placement place(const GluingProblem& problem, const LbfgsOptions& options, Stages& stage) {
  const bool is_free = problem.target.has_free_tile;
  if (problem.target.has_curved_free_tile()) return place_on_curved_tile(problem, options, stage);
  GluedEdges glued;
  const LaplacianSolver laplacian = stage("factorize", [&] {
    glued = glued_along(problem, problem.boundary);
    require_apart(glued, problem.boundary, problem.target);
    return LaplacianSolver(problem.cut, glued, problem.weights, problem.boundary, problem.laplacian);
  });
  Placement placed = stage("initialize", [&] {
    return is_free ? start_on_free_tile(problem, laplacian) : start_on_tile(problem, laplacian);
  });
  LbfgsOptions lbfgs = options;
  lbfgs.callback = [&](int iteration, const Iteration& state) {
    stage.tell({"optimize", iteration, state.energy, state.gradient_norm});
    return true;
  };
  placed.minimum = stage("optimize", [&] {  // algorithm 1
    const DirichletEnergy energy =          // (2)
        is_free ? energy_along(problem, placed.boundary)
                : DirichletEnergy(glued, problem.weights, placed.boundary);
    return minimize(energy, laplacian, std::move(placed.minimum.positions), lbfgs);
  });
  fix_poles(problem, placed);
  fix_rotation(problem, placed);
  return placed;
}

}  // namespace orbitutte
