// SPDX-License-Identifier: MIT
#include "orbitutte/solve/shared_placement.h"

#include <cmath>
#include <complex>
#include <limits>
#include <memory>
#include <utility>
#include <vector>

#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/conformal_map.h"

namespace orbitutte {
namespace {

// Positions of the input vertices with the tile that goes through them.
Placement placed_at(const GluingProblem& problem, Minimum minimum) {
  Placement placed;
  placed.minimum = std::move(minimum);
  Points& positions = placed.minimum.positions;
  placed.tile = tile_through(problem.target, problem.cut, positions);
  placed.boundary = glue(problem.cut, placed.tile, problem.target);
  placed.boundary.make_feasible(positions);
  return placed;
}

LbfgsOptions telling(const LbfgsOptions& options, const Stages& stage) {
  LbfgsOptions result = options;
  result.callback = [&stage](int iteration, const Iteration& state) {
    stage.tell({"optimize", iteration, state.energy, state.gradient_norm});
    return true;
  };
  return result;
}

// The cones of the polygon with an inscribed circle, doubled.
Points polygon_of(const Moduli& moduli) {
  const Points polygon = moduli.inscribed_polygon();
  return moduli.closed(polygon).value_or(polygon);
}

// The plane.

// What the maps of one surface onto all of its tiles are made from.
struct FlatSurface {
  explicit FlatSurface(const GluingProblem& the_problem)
      : problem(the_problem),
        glued(glued_along(problem, problem.boundary)),
        laplacian(problem.cut, glued, problem.weights, problem.boundary, problem.laplacian),
        shapes(problem, laplacian) {}

  const GluingProblem& problem;
  GluedEdges glued;
  LaplacianSolver laplacian;
  ConformalShapes shapes;

  Points own_cones() const {
    return positions_of_marks(problem.cut, shapes.own_shape())(problem.cut.marks, Eigen::all);
  }

  // The harmonic map onto the tile of a shape.
  Placement placed(const Eigen::VectorXcd& shape, const LbfgsOptions& options) const {
    Minimum start;
    start.positions = shapes.map_onto(shape);
    Placement result = placed_at(problem, std::move(start));
    const DirichletEnergy energy(glued_along(problem, result.boundary), problem.weights, result.boundary);
    result.minimum = minimize(energy, laplacian, result.minimum.positions, options);
    return result;
  }
};

// The inscribed polygon, in the order of the marks.
Eigen::VectorXcd regular_shape(const GluingProblem& problem) {
  const Points polygon = polygon_of(moduli_of(problem.target, problem.cut));
  Eigen::VectorXcd shape(polygon.rows());
  for (Eigen::Index k = 0; k < shape.size(); ++k) shape[k] = {polygon(k, 0), polygon(k, 1)};
  return shape;
}

// Gives the tile its direction, if its first mark lies at the origin.
Isometry turn_towards_x(const GluingProblem& problem, const Points& positions) {
  const Vector3 p = point_towards_x(problem.target, problem.cut, positions);
  return Space::plane().rotation(Space::origin(), -std::atan2(p.y(), p.x()));
}

std::array<std::unique_ptr<FlatSurface>, 2> flat_surfaces(const ProblemPair& problems) {
  std::array<std::unique_ptr<FlatSurface>, 2> sides;
  parallel_for(2, [&](int s) { sides[s] = std::make_unique<FlatSurface>(problems[s].get()); });
  return sides;
}

// By what a braid has moved the first mark: an isometry of the group.
Isometry motion_of_first(const GluingProblem& problem, const Eigen::VectorXcd& shape, const Braid& braid) {
  Points cones = Points::Ones(shape.size(), 3);
  cones.col(0) = shape.real();
  cones.col(1) = shape.imag();
  return motions(moduli_of(problem.target, problem.cut), cones, braid).front();
}

std::array<Placement, 2> place_in_plane(const ProblemPair& problems, const SharingOptions& options,
                                        Stages& stage) {
  const auto sides = stage("factorize", [&] { return flat_surfaces(problems); });
  const Braid to_second = inverse(options.braid);
  const int count = static_cast<int>(problems[0].get().cut.marks.size());
  const double angle = problems[0].get().target.marks.front().angle;
  const std::vector<Eigen::MatrixXcd> changes = {Eigen::MatrixXcd::Identity(count, count),
                                                 braid_matrix(count, to_second, angle)};
  Eigen::VectorXcd shape = options.is_tile_regular
                               ? sides[0]->shapes.scaled(regular_shape(problems[0]))
                               : shared_shape({&sides[0]->shapes, &sides[1]->shapes}, changes);
  shape.array() -= std::complex<double>(shape[0]);
  std::array<Placement, 2> placed;
  stage("optimize", [&] {
    const LbfgsOptions lbfgs = telling(options.lbfgs, stage);
    for (int s = 0; s < 2; ++s) placed[s] = sides[s]->placed(changes[s] * shape, lbfgs);
  });
  const Isometry turn = turn_towards_x(problems[0], placed[0].minimum.positions);
  if (!to_second.empty())
    placed[1] = moved(problems[1], motion_of_first(problems[0], shape, to_second).inverse(), placed[1]);
  placed[0] = moved(problems[0], turn, placed[0]);
  placed[1] = moved(problems[1], turn, placed[1]);
  for (Placement& each : placed) each.frame = {};
  return placed;
}

// Curved spaces.

// On two threads, so that neither tells of its progress.
std::array<TiledPositions, 2> own_curved_tiles(const ProblemPair& problems, const LbfgsOptions& options) {
  const ProgressCallback nobody;
  std::array<Timings, 2> timings;
  std::array<TiledPositions, 2> tiles;
  parallel_for(2, [&](int s) { tiles[s] = own_tile(problems[s], options, Stages(nobody, timings[s])); });
  return tiles;
}

std::array<TiledPositions, 2> polygon_tiles(const ProblemPair& problems) {
  std::array<TiledPositions, 2> tiles;
  parallel_for(2, [&](int s) { tiles[s] = polygon_tile(problems[s]); });
  return tiles;
}

// The cones moved so that the tile that is cut along them lies around (0, 0, 1), where coordinates have most
// digits: with p_2 .. p_(k - 1) it has other copies of these as corners, (R_(j + 1) ... R_k)^-1 p_j.
Points centred(const Moduli& moduli, const Points& cones) {
  const Space space = moduli.space();
  const std::vector<Isometry> rotation = moduli.generators(cones);
  Vector3 sum = cones.colwise().sum().transpose();
  Isometry gluing;
  for (Eigen::Index j = cones.rows() - 2; j > 0; --j) {
    gluing = rotation[j + 1] * gluing;
    sum += gluing.inverse() * Vector3(cones.row(j));
  }
  Points result = space.to_origin(space.retract(sum)).on_rows(cones);
  retract_points(space, result);
  return moduli.closed(result).value_or(result);
}

// The isometry that takes points to others best (k x 3 each), of those that take one of them to its partner.
Isometry alignment_of(Space space, const Points& from, const Points& to) {
  Isometry best;
  double least = std::numeric_limits<double>::infinity();
  for (Eigen::Index centre = 0; centre < from.rows(); ++centre) {
    const Isometry from_origin = space.to_origin(to.row(centre)).inverse(),
                   to_origin = space.to_origin(from.row(centre));
    std::complex<double> sum = 0;
    for (Eigen::Index k = 0; k < from.rows(); ++k) {
      const Eigen::Vector2d p = Space::conformal(to_origin * Vector3(from.row(k))),
                            q = Space::conformal(from_origin.inverse() * Vector3(to.row(k)));
      sum += std::complex<double>(q.x(), q.y()) * std::complex<double>(p.x(), -p.y());
    }
    const Isometry candidate = from_origin * space.rotation(Space::origin(), std::arg(sum)) * to_origin;
    double off = 0;
    for (Eigen::Index k = 0; k < from.rows(); ++k) {
      const double distance = space.distance(space.retract(candidate * Vector3(from.row(k))), to.row(k));
      off += distance * distance;
    }
    if (off < least) least = off, best = candidate;
  }
  return best;
}

// Positions moved so that the cones lie as near as can be to where they are to be.
Points aligned(Space space, const TiledPositions& own, const Points& cones) {
  Points result = alignment_of(space, own.cones, cones).on_rows(own.x);
  retract_points(space, result);
  return result;
}

std::array<Placement, 2> place_on_curved_tile(const ProblemPair& problems, const SharingOptions& options,
                                              Stages& stage) {
  const Moduli moduli = moduli_of(problems[0].get().target, problems[0].get().cut);
  const Braid to_second = inverse(options.braid);
  const std::array<TiledPositions, 2> first =
      options.is_tile_regular && to_second.empty() ? polygon_tiles(problems) : options.own;
  const Points cones = centred(moduli, options.is_tile_regular ? polygon_of(moduli) : first[0].cones);
  const std::vector<TileSharer> sharers = {{problems[0], {}}, {problems[1], to_second}};
  const SharedStart start = {cones,
                             {aligned(moduli.space(), first[0], cones),
                              aligned(moduli.space(), first[1], braided(moduli, cones, to_second))},
                             options.is_tile_regular};
  std::vector<Minimum> minima =
      stage("optimize", [&] { return maps_sharing_a_tile(sharers, start, options.lbfgs, stage); });
  std::array<Placement, 2> placed;
  for (int s = 0; s < 2; ++s) {
    const GluingProblem& problem = problems[s];
    Points& positions = minima[s].positions;
    positions.row(problem.cut.marks.front()) = closing_position(problem.target, problem.cut, positions);
    placed[s] = placed_at(problem, std::move(minima[s]));
  }
  const Points found = placed[0].minimum.positions(problems[0].get().cut.marks, Eigen::all);
  if (!to_second.empty())
    placed[1] = moved(problems[1], motions(moduli, found, to_second).front().inverse(), placed[1]);
  placed[0].frame = placed[1].frame = frame_of_marks(problems[0], placed[0].minimum.positions);
  return placed;
}

bool is_curved(const ProblemPair& problems) { return problems[0].get().target.has_curved_free_tile(); }

}  // namespace

std::array<TiledPositions, 2> own_tiles(const ProblemPair& problems, const LbfgsOptions& options,
                                        Stages& stage) {
  return stage("initialize", [&]() -> std::array<TiledPositions, 2> {
    if (is_curved(problems)) return own_curved_tiles(problems, options);
    const auto sides = flat_surfaces(problems);
    return {{{sides[0]->own_cones(), {}}, {sides[1]->own_cones(), {}}}};
  });
}

std::array<Placement, 2> place_together(const ProblemPair& problems, const SharingOptions& options,
                                        Stages& stage) {
  return is_curved(problems) ? place_on_curved_tile(problems, options, stage)
                             : place_in_plane(problems, options, stage);
}

}  // namespace orbitutte
