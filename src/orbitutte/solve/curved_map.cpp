// SPDX-License-Identifier: MIT
#include "orbitutte/solve/curved_map.h"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "orbitutte/linear/dissection.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/braid.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/conformal_metric.h"
#include "orbitutte/solve/development.h"
#include "orbitutte/solve/edge_words.h"
#include "orbitutte/solve/laplacian_solver.h"
#include "orbitutte/solve/moduli_energy.h"
#include "orbitutte/solve/tangent_system.h"
#include "orbitutte/solve/trust_region.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// The target with all deficits of angles scaled so that its area is another one.
Target with_area(const Target& target, double area) {
  if (area == free_tile_area(target)) return target;
  const double curvature = total_curvature(target.topology, target.marks);
  const double deficits = total_curvature(target.topology, {}) - curvature,
               wanted = deficits + curvature - target.space.curvature() * area;
  Target result = target;
  for (Mark& mark : result.marks) {
    const double ordinary = mark.kind == ConeKind::corner ? pi : 2 * pi;
    mark.angle = ordinary - (ordinary - mark.angle) * wanted / deficits;
  }
  return result;
}

// The areas of the targets on the way: the last is the target's own. Of a disk with cones a polygon with an
// inscribed circle may be made only if it is almost flat.
std::vector<double> areas_on_the_way(const Target& target) {
  const bool is_disk = target.topology == Topology::disk;
  const double small = is_disk ? 0.5 : 5, first = is_disk ? 0.5 : 3, step = is_disk ? 0.7 : 2;
  const double area = free_tile_area(target);
  if (target.space.has_convex_distances() || area <= small) return {area};
  const int steps = static_cast<int>(std::ceil((area - first) / step));
  std::vector<double> areas;
  for (int k = 0; k <= steps; ++k) areas.push_back(first + (area - first) * k / steps);
  return areas;
}

// A product of a covector field with a vector field.
double paired(const Points& covectors, const Points& vectors) {
  return covectors.cwiseProduct(vectors).sum();
}

// The words of a surface's edges, with their weights, those of the problem and their mirror images; and a
// dissection of their graph.
struct WordGraph {
  explicit WordGraph(const GluingProblem& problem)
      : edges(edge_words(problem.surface, problem.weights.triangulation.get(), problem.cut)),
        dissection(dissect(
            vertex_neighbors(connectivity_of_weights(problem).edges, problem.surface.vertex_count()))) {
    weights.w = edges.weights(problem.weights.w);
  }

  static const Connectivity& connectivity_of_weights(const GluingProblem& problem) {
    const IntrinsicTriangulation* triangulation = problem.weights.triangulation.get();
    return triangulation ? triangulation->connectivity : problem.surface.connectivity;
  }

  EdgeWords edges;
  EdgeWeights weights;
  Dissection dissection;
};

// A surface, and what it is mapped onto.
struct TileSurface {
  const GluingProblem& problem;
  const Target& target;
  const WordGraph& graph;
};

// Everything that belongs to one tile. The parts refer to each other.
struct TileSystem {
  TileSystem(const TileSurface& of, GluedEdges edges, const Points& x)
      : boundary(glue(of.problem.cut, tile_through(of.target, of.problem.cut, x), of.target)),
        glued(std::move(edges)),
        energy(glued, of.graph.weights, boundary) {}
  TileSystem(const TileSystem&) = delete;
  TileSystem& operator=(const TileSystem&) = delete;

  BoundaryConditions boundary;
  GluedEdges glued;
  DirichletEnergy energy;
};

// A tile, the harmonic map onto it, and how its energy changes with its shape.
struct HarmonicTile {
  // Of the tile that is shared, before the surface's braid.
  Points cones;
  std::unique_ptr<TileSystem> system;

  // Factorised at this tile or an earlier one, and how far the shape has moved from there.
  std::shared_ptr<const TangentSystem> hessian;
  double moved = 0;
  Minimum minimum;

  // Steps of the marks (2k, one a column) along which the shape is not looked for.
  Eigen::MatrixXd held;

  // Of the shapes (Moduli::basis), those that are held left out, and the derivative of the energy along it.
  Eigen::MatrixXd basis;
  Eigen::VectorXd slope;

  const Points& x() const { return minimum.positions; }
};

// The energy as a function of the shape to second order, and what the positions do meanwhile.
struct ShapeModel {
  QuadraticModel energy;
  std::vector<Points> responses;

  Points response(const Eigen::VectorXd& step) const {
    Points sum = Points::Zero(responses.front().rows(), 3);
    for (std::size_t a = 0; a < responses.size(); ++a)
      sum += step[static_cast<Eigen::Index>(a)] * responses[a];
    return sum;
  }
};

// The search over the shapes of one target, as one surface sees it.
class ShapeSearch {
 public:
  ShapeSearch(const TileSharer& sharer, const Target& target, const WordGraph& graph)
      : problem_(sharer.problem),
        target_(target),
        braid_(sharer.braid),
        graph_(graph),
        moduli_(moduli_of(target, problem_.cut)),
        energy_(moduli_, graph.edges, graph.weights.w, cones_as_met(problem_.cut)) {}

  const Moduli& moduli() const { return moduli_; }

  // The harmonic map onto the tile of these cones, up to a tolerance, from positions near it.
  HarmonicTile harmonic(const Points& cones, const Points& start, const LbfgsOptions& options) const {
    HarmonicTile tile = started(cones, start);
    tile.hessian = std::make_shared<TangentSystem>(tangent_problem(*tile.system), tile.minimum.positions);
    relax(options, tile);
    return tile;
  }

  // The same from a tile whose shape is so far away: nearby its factor serves once more.
  HarmonicTile harmonic_beside(const HarmonicTile& from, double distance, const TiledPositions& start,
                               const LbfgsOptions& options) const {
    HarmonicTile tile = started(start.cones, start.x);
    tile.held = from.held;
    if (serves_again(from, distance)) {
      tile.hessian = std::make_shared<TangentSystem>(from.hessian->moved_to(tile.x()));
      tile.moved = from.moved + distance;
    } else {
      tile.hessian = std::make_shared<TangentSystem>(tangent_problem(*tile.system), tile.x());
    }
    relax(options, tile);
    return tile;
  }

  // With the directions held in which great cones leave the energy almost flat, the least eigenvectors of its
  // second derivative: as many as there are turns in excess. Maps that run around such a cone fewer times
  // than they should are as conformal everywhere else.
  void hold_flat_directions(HarmonicTile& tile) const {
    int flat = 0;
    for (const Mark& mark : moduli_.marks())
      flat += (mark.kind == ConeKind::corner ? 1 : 2) * turns_in_excess(mark);
    if (flat == 0) return;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(model(tile).energy.hessian);
    tile.held = tile.basis * eigen.eigenvectors().leftCols(std::min<Eigen::Index>(flat, tile.basis.cols()));
    find_slope(tile);
  }

  // Is the energy there about as small as that of a conformal map?
  bool is_good(const TiledPositions& start) const {
    constexpr double largest_conformality = 1.5;
    const HarmonicTile tile = started(start.cones, start.x);
    const double energy = tile.system->energy.evaluate(tile.x()).energy;
    return energy < largest_conformality * 2 * moduli_.area();
  }

  ShapeModel model(const HarmonicTile& tile) const {
    const ModuliEnergy::Curvature curvature =
        energy_.curvature(tile.x(), met(tile.cones, tile.basis, Order::second));
    ShapeModel model = {{tile.slope, curvature.energy + bending(tile)}, {}};
    model.responses = tile.hessian->beside(tangent_problem(*tile.system), tile.x()).solve(curvature.gradient);
    for (Points& response : model.responses) response *= -1;
    for (Eigen::Index a = 0; a < tile.basis.cols(); ++a)
      for (Eigen::Index b = 0; b < tile.basis.cols(); ++b)
        model.energy.hessian(a, b) += 0.5 * (paired(curvature.gradient[a], model.responses[b]) +
                                             paired(curvature.gradient[b], model.responses[a]));
    return model;
  }

  std::optional<Points> moved_cones(const HarmonicTile& tile, const Eigen::VectorXd& step) const {
    return moduli_.retract(tile.cones, tile.basis * step);
  }

 private:
  // Where the boundary of this surface's cut mesh meets the cones.
  Points own(const Points& cones) const { return braided(moduli_, cones, braid_); }

  // The same of cones that move along directions.
  VaryingMarks met(const Points& cones, const Eigen::MatrixXd& directions, Order order) const {
    return braided(moduli_.varying(cones, directions, order), braid_);
  }

  TangentProblem tangent_problem(const TileSystem& system) const {
    return {system.glued, graph_.weights.w, system.boundary, graph_.dissection,
            problem_.laplacian.options.backend};
  }

  // Does a tile's factor precondition that of another one so far away? Where the map took many iterations, it
  // had moved far from where the factor was made.
  static bool serves_again(const HarmonicTile& tile, double distance) {
    constexpr double nearby = 0.1;
    constexpr int few_iterations = 4;
    return tile.hessian->is_exact() && tile.moved + distance <= nearby &&
           tile.minimum.iterations <= few_iterations;
  }

  // The tile of these cones, with positions from which its map can be relaxed.
  HarmonicTile started(const Points& cones, const Points& start) const {
    HarmonicTile tile;
    tile.cones = cones;
    const Points met = own(cones);
    Points& x = tile.minimum.positions = energy_.with_cones(start, met);
    tile.system = std::make_unique<TileSystem>(TileSurface{problem_, target_, graph_}, energy_.glued(met), x);
    tile.system->boundary.make_feasible(x);
    return tile;
  }

  void relax(const LbfgsOptions& options, HarmonicTile& tile) const {
    tile.minimum = minimize(tile.system->energy, *tile.hessian, tile.minimum.positions, options);
    find_slope(tile);
  }

  void find_slope(HarmonicTile& tile) const {
    tile.basis = moduli_.basis(tile.cones);
    if (tile.held.cols() > 0) {
      const Eigen::HouseholderQR<Eigen::MatrixXd> factors(tile.basis.transpose() * tile.held);
      const Eigen::MatrixXd Q = factors.householderQ();
      tile.basis = tile.basis * Q.rightCols(tile.basis.cols() - tile.held.cols());
    }
    tile.slope = energy_.cone_gradient(tile.x(), met(tile.cones, tile.basis, Order::first));
  }

  // What the closing adds to the second derivative: tiles that close bend away from geodesic steps, across
  // the steps that keep them closed, where the energy has a slope, a combination of those of the closing.
  Eigen::MatrixXd bending(const HarmonicTile& tile) const {
    const Eigen::Index steps = 2 * moduli_.mark_count();
    const Eigen::VectorXd slope = energy_.cone_gradient(
        tile.x(), met(tile.cones, Eigen::MatrixXd::Identity(steps, steps), Order::first));
    const Eigen::MatrixXd across = moduli_.closing_jacobian(tile.cones).transpose();
    const Eigen::VectorXd multipliers = -across.completeOrthogonalDecomposition().solve(slope);
    return moduli_.varying(tile.cones, tile.basis, Order::second).closing_curvature(multipliers);
  }

  const GluingProblem& problem_;
  const Target& target_;
  Braid braid_;
  const WordGraph& graph_;
  Moduli moduli_;
  ModuliEnergy energy_;
};

// The harmonic maps of all surfaces onto one tile.
struct SharedTile {
  std::vector<HarmonicTile> maps;

  const Points& cones() const { return maps.front().cones; }

  double energy() const {
    double sum = 0;
    for (const HarmonicTile& map : maps) sum += map.minimum.energy;
    return sum;
  }

  // Of the energy, along the basis.
  Eigen::VectorXd slope() const {
    Eigen::VectorXd sum = maps.front().slope;
    for (std::size_t s = 1; s < maps.size(); ++s) sum += maps[s].slope;
    return sum;
  }

  double steepest() const {
    const Eigen::VectorXd all = slope();
    return all.size() > 0 ? all.cwiseAbs().maxCoeff() : 0;
  }
};

// The energy of all maps to second order, and what the positions of each do meanwhile.
struct SharedModel {
  QuadraticModel energy;
  std::vector<ShapeModel> of_maps;
};

// The trust region's steps through the shapes, of one surface or of several that share the tile.
class ShapeDescent {
 public:
  ShapeDescent(std::vector<const ShapeSearch*> searches, const LbfgsOptions& options, const Stages& stage)
      : searches_(std::move(searches)), options_(options), stage_(stage) {}

  // From the cones of a tile and positions of each surface; a minimum for each.
  std::vector<Minimum> run(const Points& cones, const std::vector<Points>& starts) {
    SharedTile tile = first_tile(cones, starts);
    // Tiles that are shared have no great cones.
    if (searches_.size() == 1) searches_.front()->hold_flat_directions(tile.maps.front());
    add_row(tile, 0);
    for (int step = 0; step < most_steps && tile.steepest() > slope_tolerance(); ++step)
      if (!advance(tile)) break;
    return finished(tile);
  }

  // The same without a step: onto the tile of these cones.
  std::vector<Minimum> stay(const Points& cones, const std::vector<Points>& starts) {
    const SharedTile tile = first_tile(cones, starts);
    add_row(tile, 0);
    return minima(last_tile(tile));
  }

 private:
  static constexpr int most_steps = 60;

  // How far a harmonic map may be from its minimum while the shape is far from its own.
  static constexpr double loosest = 1e-5;

  double slope_tolerance() const { return 0.05 * options_.tolerance; }

  LbfgsOptions within(double tolerance) const {
    LbfgsOptions options = options_;
    options.tolerance = std::max(tolerance, options_.tolerance);
    options.callback = [this](int iteration, const Iteration& state) {
      stage_.tell({"optimize", iterations_ + iteration, state.energy, state.gradient_norm});
      return true;
    };
    return options;
  }

  SharedTile first_tile(const Points& cones, const std::vector<Points>& starts) const {
    SharedTile tile;
    for (std::size_t s = 0; s < searches_.size(); ++s)
      tile.maps.push_back(searches_[s]->harmonic(cones, starts[s], within(loosest)));
    return tile;
  }

  // The same tile, its maps up to the tolerance that is asked for.
  SharedTile last_tile(const SharedTile& tile) const {
    SharedTile last;
    for (std::size_t s = 0; s < searches_.size(); ++s)
      last.maps.push_back(searches_[s]->harmonic_beside(tile.maps[s], 0, {tile.cones(), tile.maps[s].x()},
                                                        within(options_.tolerance)));
    return last;
  }

  std::vector<Minimum> minima(const SharedTile& last) const {
    std::vector<Minimum> result;
    for (const HarmonicTile& map : last.maps) {
      result.push_back(map.minimum);
      result.back().shapes = rows_;
      result.back().iterations += iterations_;
      result.back().evaluations += evaluations_;
    }
    return result;
  }

  std::vector<Minimum> finished(const SharedTile& tile) const {
    const SharedTile last = last_tile(tile);
    std::vector<Minimum> result = minima(last);
    const bool is_shape_found =
        last.steepest() <= std::max({1000 * slope_tolerance(), 1e-6, 1e-7 * squared_reach(last)});
    for (Minimum& minimum : result)
      if (!is_shape_found && minimum.termination == Termination::converged)
        minimum.termination = Termination::max_iterations;
    return result;
  }

  void add_row(const SharedTile& tile, double length) {
    rows_.push_back({tile.energy(), tile.steepest(), length});
    for (const HarmonicTile& map : tile.maps) {
      iterations_ += map.minimum.iterations;
      evaluations_ += map.minimum.evaluations;
    }
  }

  SharedModel model(const SharedTile& tile) const {
    SharedModel model;
    for (std::size_t s = 0; s < searches_.size(); ++s) {
      model.of_maps.push_back(searches_[s]->model(tile.maps[s]));
      const QuadraticModel& energy = model.of_maps.back().energy;
      if (s == 0) {
        model.energy = energy;
      } else {
        model.energy.gradient += energy.gradient;
        model.energy.hessian += energy.hessian;
      }
    }
    return model;
  }

  // One accepted step; false if there is none.
  bool advance(SharedTile& tile) {
    constexpr int most_trials = 12;
    const SharedModel model = this->model(tile);
    for (int trial = 0; trial < most_trials; ++trial) {
      const Eigen::VectorXd step = trust_region_step(model.energy, radius_);
      const double promised = -model.energy(step), length = step.norm();
      std::optional<SharedTile> next = tile_after(tile, model, step);
      if (next && is_better(tile, *next, promised)) {
        adapt_radius((tile.energy() - next->energy()) / promised, length);
        tile = std::move(*next);
        add_row(tile, length);
        return true;
      }
      if (is_hidden(tile, promised)) break;
      radius_ = length / 3;
    }
    return false;
  }

  std::optional<SharedTile> tile_after(const SharedTile& tile, const SharedModel& model,
                                       const Eigen::VectorXd& step) const {
    const std::optional<Points> cones = searches_.front()->moved_cones(tile.maps.front(), step);
    if (!cones) return std::nullopt;
    // So many vertices may be off that their sum would show in the slope.
    const LbfgsOptions options = within(std::min(loosest, 1e-6 * tile.steepest()));
    SharedTile next;
    for (std::size_t s = 0; s < searches_.size(); ++s) {
      const HarmonicTile& map = tile.maps[s];
      Points x;
      move_points(searches_[s]->moduli().space(), map.x(), model.of_maps[s].response(step), 1, x);
      if (!x.allFinite()) x = map.x();
      next.maps.push_back(searches_[s]->harmonic_beside(map, step.norm(), {*cones, x}, options));
    }
    return next;
  }

  // Where rounding hides the change of the energy, by its slope.
  static bool is_better(const SharedTile& from, const SharedTile& to, double promised) {
    constexpr double least_share = 0.05;
    if (is_hidden(from, promised)) return to.steepest() < 0.5 * from.steepest();
    return from.energy() - to.energy() > least_share * promised;
  }

  // Is a change of the energy hidden by rounding? That of the tile itself, which closes up to it, grows with
  // the square of the coordinates.
  static bool is_hidden(const SharedTile& tile, double change) {
    return change <= 1e-12 * squared_reach(tile) * tile.energy();
  }

  static double squared_reach(const SharedTile& tile) {
    return std::max(1.0, tile.cones().cwiseAbs2().maxCoeff());
  }

  void adapt_radius(double share, double length) {
    constexpr double widest = 2;
    if (share > 0.7 && length > 0.8 * radius_) radius_ = std::min(2 * radius_, widest);
    if (share < 0.25) radius_ = length / 2;
  }

  std::vector<const ShapeSearch*> searches_;
  const LbfgsOptions& options_;
  const Stages& stage_;
  double radius_ = 0.5;
  int iterations_ = 0, evaluations_ = 0;
  std::vector<Iteration> rows_;
};

// What the angles around each vertex are to add up to.
Eigen::VectorXd angles_around_vertices(const GluingProblem& problem) {
  const Surface& surface = problem.surface;
  const std::vector<char> on_boundary = surface.boundary_vertices();
  Eigen::VectorXd angles = Eigen::VectorXd::Zero(surface.vertex_count());
  for (const int v : surface.triangles.reshaped()) angles[v] = on_boundary[v] ? pi : 2 * pi;
  for (std::size_t k = 0; k < problem.target.marks.size(); ++k)
    angles[problem.cut.marks[k]] = problem.target.marks[k].angle;
  return angles;
}

// Where the boundary of the cut mesh first meets each cone, in that order.
Points cones_when_met(const CutMesh& cut, const Points& positions) {
  const std::vector<int> cones = cones_as_met(cut);
  Points result(static_cast<Eigen::Index>(cones.size()), 3);
  for (std::size_t k = 0; k < cones.size(); ++k) {
    const int first = *std::find_if(cut.boundary.begin(), cut.boundary.end(),
                                    [&](int v) { return cut.source_vertex[v] == cones[k]; });
    result.row(static_cast<Eigen::Index>(k)) = positions.row(first);
  }
  return result;
}

// The surface with its discretely conformal metric, developed; nothing where its triangles have none.
std::optional<TiledPositions> developed_start(const GluingProblem& problem, const Dissection& dissection) {
  constexpr double largest_defect = 0.5;
  const Space space = problem.target.space;
  const ConformalMetric metric =
      conformal_metric({problem.surface, space, angles_around_vertices(problem), problem.weights, dissection,
                        problem.laplacian.options.backend});
  if (!(metric.defect < largest_defect)) return std::nullopt;
  const Points positions = developed(problem.surface, problem.cut, space, metric);
  if (!positions.allFinite()) return std::nullopt;
  const std::optional<Points> cones =
      moduli_of(problem.target, problem.cut).closed(cones_when_met(problem.cut, positions));
  if (!cones) return std::nullopt;
  return TiledPositions{*cones, positions.topRows(problem.surface.vertex_count())};
}

// Positions of the corners of the first tile: the cones of the inscribed polygon, and for all other vertices
// the mean of these, the nearer ones counting more, so that where cuts branch they lie between.
Points corners_of_polygon(const GluingProblem& problem, const Moduli& moduli) {
  const std::vector<int> cones = cones_as_met(problem.cut);
  const Points inscribed = moduli.inscribed_polygon(), polygon = moduli.closed(inscribed).value_or(inscribed);
  const Points& V = problem.surface.V;
  Points x(V.rows(), 3);
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    Vector3 sum = Vector3::Zero();
    for (std::size_t k = 0; k < cones.size(); ++k) {
      const double squared = (V.row(v) - V.row(cones[k])).squaredNorm();
      sum += polygon.row(static_cast<Eigen::Index>(k)).transpose() / std::max(squared, 1e-300);
    }
    x.row(v) = moduli.space().retract(sum);
  }
  for (std::size_t k = 0; k < cones.size(); ++k) x.row(cones[k]) = polygon.row(static_cast<Eigen::Index>(k));
  return x;
}

// On the sphere, the harmonic map to R^3 that is glued like the tile, its cones held, moved to the sphere.
// The operator of that is indefinite in the hyperbolic plane, where the energy of maps onto one tile is
// convex: there the start is a matter of speed alone.
Points first_map(const GluingProblem& problem, const Target& target, const Points& corners) {
  if (target.space.has_convex_distances()) return corners;
  const Tile tile = tile_through(target, problem.cut, corners);
  const BoundaryConditions boundary = glue(problem.cut, tile, target);
  const GluedEdges glued = glued_along(problem, boundary);
  const LaplacianSolver laplacian(problem.cut, glued, problem.weights, boundary, problem.laplacian);
  Points x = Points::Zero(corners.rows(), 3);
  for (const int v : problem.cut.marks) x.row(v) = corners.row(v);
  Points pull = Points::Zero(corners.rows(), 3);
  for (std::size_t e = 0; e < glued.edges.size(); ++e) {
    const auto& [i, j, t] = glued.edges[e];
    const Isometry& g = glued.transforms[t];
    const Vector3 difference =
        2 * problem.weights.w[static_cast<Eigen::Index>(e)] * (Vector3(x.row(i)) - g * Vector3(x.row(j)));
    pull.row(i) += difference;
    pull.row(j) -= g.inverse_matrix() * difference;
  }
  for (const int v : problem.cut.marks) pull.row(v).setZero();
  x -= laplacian.precondition(pull);
  boundary.make_feasible(x);
  return x;
}

// The first map onto the tile of the polygon with an inscribed circle.
Points start_on_polygon(const GluingProblem& problem, const Target& target, const Moduli& moduli) {
  return first_map(problem, target, corners_of_polygon(problem, moduli));
}

// Positions that are about harmonic on the tile of these cones, from any. Far from them a factor serves for
// some iterations only.
Points approached(const ShapeSearch& search, const Points& cones, const Points& start,
                  const LbfgsOptions& options) {
  constexpr int most_rounds = 20, few_iterations = 8, most_iterations = 40;
  LbfgsOptions within = options;
  within.tolerance = std::max(options.tolerance, 1e-5);
  within.max_iterations = std::min(options.max_iterations, most_iterations);
  within.callback = {};
  Minimum minimum;
  minimum.positions = start;
  for (int round = 0; round < most_rounds; ++round) {
    minimum = search.harmonic(cones, minimum.positions, within).minimum;
    if (minimum.iterations <= few_iterations) break;
  }
  return minimum.positions;
}

// From the polygon with an inscribed circle, through tiles of less area.
class AreaContinuation {
 public:
  AreaContinuation(const GluingProblem& problem, const WordGraph& graph) : problem_(problem), graph_(graph) {}

  Minimum run(const LbfgsOptions& options, const Stages& stage) const {
    Minimum minimum;
    for (const double area : areas_on_the_way(problem_.target)) {
      const Target target = with_area(problem_.target, area);
      const ShapeSearch search({problem_, {}}, target, graph_);
      if (minimum.positions.size() == 0)
        minimum.positions = start_on_polygon(problem_, target, search.moduli());
      LbfgsOptions within = options;
      if (area < free_tile_area(problem_.target)) within.tolerance = std::max(options.tolerance, 1e-4);
      const Points cones = cones_of(minimum.positions, search.moduli());
      if (target.space.has_convex_distances())
        minimum.positions = approached(search, cones, minimum.positions, within);
      minimum = ShapeDescent({&search}, within, stage).run(cones, {minimum.positions}).front();
    }
    return minimum;
  }

 private:
  Points cones_of(const Points& x, const Moduli& moduli) const {
    if (const std::optional<Points> cones = moduli.closed(x(cones_as_met(problem_.cut), Eigen::all)))
      return *cones;
    throw MeshError(
        fmt::format("the search for the shape of the tile of {} failed at the area {:.4g} of {:.4g}; mark "
                    "other vertices, "
                    "or take other angles",
                    problem_.target.signature, moduli.area(), free_tile_area(problem_.target)));
  }

  const GluingProblem& problem_;
  const WordGraph& graph_;
};

// The developed surface, if its map is about conformal.
std::optional<TiledPositions> good_start(const GluingProblem& problem, const WordGraph& graph) {
  std::optional<TiledPositions> start = developed_start(problem, graph.dissection);
  if (start && !ShapeSearch({problem, {}}, problem.target, graph).is_good(*start)) start.reset();
  return start;
}

// So that other cuts give the same lengths to ten times the tolerance.
LbfgsOptions tightened(LbfgsOptions options) {
  options.tolerance *= 0.1;
  return options;
}

// What belongs to surfaces that share a tile. The searches refer to the rest.
struct Sharing {
  explicit Sharing(const std::vector<TileSharer>& sharers) {
    for (const TileSharer& sharer : sharers) {
      graphs.push_back(std::make_unique<WordGraph>(sharer.problem));
      owned.push_back(std::make_unique<ShapeSearch>(sharer, sharer.problem.target, *graphs.back()));
      searches.push_back(owned.back().get());
    }
  }

  std::vector<std::unique_ptr<WordGraph>> graphs;
  std::vector<std::unique_ptr<ShapeSearch>> owned;
  std::vector<const ShapeSearch*> searches;
};

}  // namespace

Minimum curved_map(const GluingProblem& problem, const LbfgsOptions& options, const Stages& stage) {
  const WordGraph graph(problem);
  const LbfgsOptions within = tightened(options);
  if (const std::optional<TiledPositions> start = good_start(problem, graph)) {
    const ShapeSearch search({problem, {}}, problem.target, graph);
    return ShapeDescent({&search}, within, stage).run(start->cones, {start->x}).front();
  }
  return AreaContinuation(problem, graph).run(within, stage);
}

TiledPositions own_tile(const GluingProblem& problem, const LbfgsOptions& options, const Stages& stage) {
  const WordGraph graph(problem);
  if (std::optional<TiledPositions> start = good_start(problem, graph)) return std::move(*start);
  Points x = AreaContinuation(problem, graph).run(options, stage).positions;
  return {x(cones_as_met(problem.cut), Eigen::all), x};
}

TiledPositions polygon_tile(const GluingProblem& problem) {
  const Moduli moduli = moduli_of(problem.target, problem.cut);
  const Points x = start_on_polygon(problem, problem.target, moduli);
  return {x(cones_as_met(problem.cut), Eigen::all), x};
}

std::vector<Minimum> maps_sharing_a_tile(const std::vector<TileSharer>& sharers, const SharedStart& start,
                                         const LbfgsOptions& options, const Stages& stage) {
  const Sharing sharing(sharers);
  const LbfgsOptions within = tightened(options);
  std::vector<Points> x(start.x.size());
  parallel_for(static_cast<int>(x.size()),
               [&](int s) { x[s] = approached(*sharing.searches[s], start.cones, start.x[s], within); });
  ShapeDescent descent(sharing.searches, within, stage);
  return start.is_tile_held ? descent.stay(start.cones, x) : descent.run(start.cones, x);
}

}  // namespace orbitutte
