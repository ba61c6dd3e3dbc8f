// SPDX-License-Identifier: MIT
#include "orbitutte/solve/curved_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/solve/initial_embedding.h"
#include "orbitutte/solve/moduli_energy.h"
#include "orbitutte/solve/tangent_system.h"
#include "orbitutte/weights/cone_weights.h"
#include "sample_embeddings.h"
#include "test_meshes.h"

namespace orbitutte::curved_map_test {
namespace {

using std::numbers::pi;

// Five cones of unequal angles on the sphere, in the plane and in the hyperbolic plane.
std::vector<double> some_angles(int k) {
  if (k > 0) return {1.6 * pi, 1.5 * pi, 1.7 * pi, 1.55 * pi, 1.65 * pi};
  if (k == 0) return {1.1 * pi, 1.3 * pi, 1.2 * pi, 0.9 * pi, 1.5 * pi};
  return {pi, 0.9 * pi, 1.1 * pi, 0.8 * pi, pi};
}

// A cut surface and all that a search for its shape begins with.
struct CutSurface {
  CutSurface(const std::vector<double>& angles, std::uint64_t seed)
      : surface(make_surface(test::perturbed(test::icosphere(2), 0.03, 7))),
        cones(choose_extremities(surface, {static_cast<int>(angles.size()), 0})),
        target(cone_target(Topology::sphere, marks_of(angles))),
        weights(sharpened_at_cones(edge_weights(surface, {}), metric(angles))),
        cut(cut_along_tree(surface, cones, static_cast<int>(cones.size()), {seed})),
        moduli(moduli_of(target, cut)),
        words(edge_words(surface, weights.triangulation.get(), cut)),
        energy(moduli, words, words.weights(weights.w), cones_as_met(cut)) {}

  static std::vector<Mark> marks_of(const std::vector<double>& angles) {
    std::vector<Mark> marks;
    for (const double angle : angles) marks.push_back({angle, ConeKind::rotation});
    return marks;
  }

  std::vector<ConeAngle> metric(const std::vector<double>& angles) const {
    std::vector<ConeAngle> result;
    for (std::size_t k = 0; k < angles.size(); ++k) result.push_back({cones[k], angles[k]});
    return result;
  }

  Tile tile() const { return any_tile(target, cut); }
  GluingProblem problem() const {
    const Tile first = tile();
    return {surface, cut, target, weights, {}, first, glue(cut, first, target)};
  }

  // Positions near those of a start: scattered about (0, 0, 1), the cones at the polygon's corners.
  Points scattered() const {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-0.4, 0.4);
    Points x(surface.vertex_count(), 3);
    for (Eigen::Index v = 0; v < x.rows(); ++v)
      x.row(v) = target.space.lift(uniform(random), uniform(random)).transpose();
    return energy.with_cones(x, polygon());
  }

  Points polygon() const { return moduli.inscribed_polygon(); }

  Surface surface;
  std::vector<int> cones;
  Target target;
  EdgeWeights weights;
  CutMesh cut;
  Moduli moduli;
  EdgeWords words;
  ModuliEnergy energy;
};

class EveryCutSurface : public testing::TestWithParam<int> {
 protected:
  CutSurface cut_surface(std::uint64_t seed = 0) const { return {some_angles(GetParam()), seed}; }
};

INSTANTIATE_TEST_SUITE_P(Geometry, EveryCutSurface, testing::Values(1, 0, -1), [](const auto& info) {
  return info.param > 0 ? "sphere" : info.param == 0 ? "plane" : "hyperboloid";
});

// At cones elements are not unique, but images are.
TEST_P(EveryCutSurface, WordsGlueEdgesAsTheTileDoes) {
  for (const std::uint64_t seed : {0u, 5u}) {
    const CutSurface s = cut_surface(seed);
    Points x = s.scattered();
    const BoundaryConditions boundary = glue(s.cut, tile_through(s.target, s.cut, x), s.target);
    boundary.make_feasible(x);
    const double by_words =
        DirichletEnergy(s.energy.glued(s.polygon()), s.weights, boundary).evaluate(x).energy;
    const GluingProblem problem = s.problem();
    const double by_tile =
        DirichletEnergy(glued_along(problem, boundary), s.weights, boundary).evaluate(x).energy;
    EXPECT_NEAR(by_words, by_tile, 1e-9 * by_tile) << "seed " << seed;
  }
}

TEST_P(EveryCutSurface, TheEnergysDerivativeByTheConesIsThatOfDifferences) {
  const CutSurface s = cut_surface();
  const Points x = s.scattered(), cones = s.polygon();
  const Eigen::VectorXd gradient = s.energy.cone_gradient(x, cones);
  const auto moved = [&](const Eigen::VectorXd& step) {
    const Points direction = s.moduli.tangents(cones, step);
    Points result;
    move_points(s.target.space, cones, direction, 1, result);
    return result;
  };
  constexpr double h = 1e-5;
  for (Eigen::Index q = 0; q < gradient.size(); ++q) {
    const Eigen::VectorXd step = h * Eigen::VectorXd::Unit(gradient.size(), q);
    const double difference = (s.energy.energy(x, moved(step)) - s.energy.energy(x, moved(-step))) / (2 * h);
    EXPECT_NEAR(gradient[q], difference, 1e-6 * gradient.norm()) << q;
  }
}

// Also for steps in two directions at once.
TEST_P(EveryCutSurface, TheEnergysSecondDerivativesByTheConesAreThoseOfDifferences) {
  const CutSurface s = cut_surface();
  const Points x = s.scattered(), cones = s.polygon();
  const Eigen::MatrixXd directions = Eigen::MatrixXd::Random(2 * s.moduli.mark_count(), 3);
  const ModuliEnergy::Curvature second = s.energy.curvature(x, cones, directions);
  const auto moved = [&](const Eigen::VectorXd& step) {
    Points result;
    move_points(s.target.space, cones, s.moduli.tangents(cones, directions * step), 1, result);
    return result;
  };
  constexpr double h = 1e-5, wide = 2e-4;
  const double here = s.energy.energy(x, cones);
  for (Eigen::Index q = 0; q < 3; ++q) {
    const Eigen::VectorXd step = Eigen::VectorXd::Unit(3, q),
                          both = step + Eigen::VectorXd::Unit(3, (q + 1) % 3);
    const Points change =
        (s.energy.gradient(x, moved(h * step)) - s.energy.gradient(x, moved(-h * step))) / (2 * h);
    EXPECT_LT((second.gradient[q] - change).norm(), 1e-6 * change.norm()) << q;
    const double bend =
        (s.energy.energy(x, moved(wide * both)) - 2 * here + s.energy.energy(x, moved(-wide * both))) /
        (wide * wide);
    EXPECT_NEAR(both.dot(second.energy * both), bend, 1e-5 * second.energy.norm()) << q;
  }
}

// H^-1 of the change of the gradient along a direction is the direction.
TEST_P(EveryCutSurface, TheTangentSystemInvertsTheSecondDerivative) {
  const CutSurface s = cut_surface();
  const GluingProblem problem = s.problem();
  Points x = s.energy.with_cones(
      initial_embedding(
          s.surface, s.cut, problem.tile, problem.boundary,
          LaplacianSolver(s.cut, glued_along(problem, problem.boundary), s.weights, problem.boundary)),
      s.polygon());
  const GluedEdges glued = s.energy.glued(s.polygon());
  const DirichletEnergy energy(glued, s.weights, problem.boundary);
  const Dissection dissection =
      dissect(vertex_neighbors(s.weights.triangulation->connectivity.edges, s.surface.vertex_count()));
  const TangentSystem system({glued, s.weights.w, problem.boundary, dissection, available_backends().front()},
                             x);
  if (!system.is_exact()) {
    ASSERT_GT(GetParam(), 0) << "only on the sphere it need not be positive";
    return;
  }
  const Points gradient = energy.evaluate(x).gradient;
  constexpr double h = 1e-4;
  const Points direction = system.precondition(gradient);
  Points there, back;
  move_points(s.target.space, x, direction, h, there);
  move_points(s.target.space, x, direction, -h, back);
  const Points change = (energy.evaluate(there).gradient - energy.evaluate(back).gradient) / (2 * h);
  const Points recovered = system.precondition(change);
  EXPECT_LT((recovered - direction).cwiseAbs().maxCoeff(), 1e-3 * direction.cwiseAbs().maxCoeff());
}

// The system of one map, refined by the Hessian of another nearby, inverts that; so does the system whose
// frames alone were moved, but not as well.
TEST_P(EveryCutSurface, ATangentSystemServesForMapsNearby) {
  const CutSurface s = cut_surface();
  const GluingProblem problem = s.problem();
  const GluedEdges glued = s.energy.glued(s.polygon());
  const DirichletEnergy energy(glued, s.weights, problem.boundary);
  const Dissection dissection =
      dissect(vertex_neighbors(s.weights.triangulation->connectivity.edges, s.surface.vertex_count()));
  const TangentProblem tangent = {glued, s.weights.w, problem.boundary, dissection,
                                  available_backends().front()};
  const GluedEdges at_start = glued_along(problem, problem.boundary);
  const LaplacianSolver laplacian(s.cut, at_start, s.weights, problem.boundary);
  const Points x = s.energy.with_cones(
      initial_embedding(s.surface, s.cut, problem.tile, problem.boundary, laplacian), s.polygon());
  const TangentSystem system(tangent, x);
  if (!system.is_exact()) {
    ASSERT_GT(GetParam(), 0) << "only on the sphere it need not be positive";
    return;
  }
  const Points gradient = energy.evaluate(x).gradient, direction = system.precondition(gradient);
  const double step = 0.02 / direction.cwiseAbs().maxCoeff();
  Points beside;
  move_points(s.target.space, x, direction, step, beside);
  const Points covector = energy.evaluate(beside).gradient,
               wanted = TangentSystem(tangent, beside).precondition(covector),
               refined = system.beside(tangent, beside).solve({covector, gradient}).front(),
               moved = system.moved_to(beside).precondition(covector);
  const double size = wanted.cwiseAbs().maxCoeff(), error = (refined - wanted).cwiseAbs().maxCoeff();
  EXPECT_LT(error, 0.02 * size);
  EXPECT_LT((moved - wanted).cwiseAbs().maxCoeff(), 0.2 * size);
  EXPECT_LE(error, (moved - wanted).cwiseAbs().maxCoeff() + 1e-5 * size);
}

Eigen::VectorXd edge_lengths(const CutSurface& s, const Minimum& minimum) {
  const Tile tile = tile_through(s.target, s.cut, minimum.positions);
  const BoundaryConditions boundary = glue(s.cut, tile, s.target);
  const Points all = boundary.spread(minimum.positions, s.cut.source_vertex);
  Eigen::VectorXd lengths(static_cast<Eigen::Index>(s.surface.connectivity.edges.size()));
  for (int h = 0; h < static_cast<int>(s.cut.F.size()); ++h)
    lengths[s.surface.connectivity.edge_of[s.cut.source_halfedge(h)]] =
        s.target.space.distance(all.row(halfedge_origin(s.cut.F, h)), all.row(halfedge_target(s.cut.F, h)));
  return lengths;
}

TEST(CurvedMap, IsConformalAndTheSameForAllCuts) {
  for (const int k : {1, -1}) {
    Eigen::VectorXd first;
    for (const std::uint64_t seed : {0u, 3u, 8u}) {
      const CutSurface s(some_angles(k), seed);
      const GluingProblem problem = s.problem();
      Timings timings;
      const ProgressCallback silent;
      const Minimum minimum = curved_map(problem, {}, Stages(silent, timings));
      EXPECT_EQ(minimum.termination, Termination::converged);
      const double conformality = minimum.energy / (2 * free_tile_area(s.target));
      EXPECT_NEAR(conformality, 1, 0.02) << k;
      EXPECT_FALSE(minimum.shapes.empty());
      EXPECT_LT(minimum.shapes.back().gradient_norm, 1e-7);
      const Eigen::VectorXd lengths = edge_lengths(s, minimum);
      if (first.size() == 0) first = lengths;
      EXPECT_LT((lengths - first).cwiseAbs().maxCoeff(), 5e-8) << "space " << k << " seed " << seed;
    }
  }
}

// Their tile has no freedom: the map is that of the orbifold with the same cones.
TEST(CurvedMap, ThreeConesWithTheAnglesOfAnOrbifoldGiveItsMap) {
  for (const char* signature : {"222", "322", "223", "432"}) {
    const Target orbifold = parse_orbifold(signature);
    const Mesh mesh = test::sample_mesh_for(orbifold);
    const std::vector<int> cones = choose_cones(mesh, orbifold);
    const EmbedResult of_symbol = embed(mesh, orbifold, cones),
                      of_angles = embed(mesh, cone_target(Topology::sphere, orbifold.marks), cones);
    EXPECT_TRUE(of_angles.certificate.bijective) << signature;
    EXPECT_NEAR(of_angles.minimum.energy, of_symbol.minimum.energy, 1e-9 * of_symbol.minimum.energy)
        << signature;
    const Eigen::VectorXd apart =
        test::edge_lengths(mesh, of_angles.embedding) - test::edge_lengths(mesh, of_symbol.embedding);
    EXPECT_LT(apart.cwiseAbs().maxCoeff(), 1e-6) << signature;
  }
}

TEST(CurvedMap, CanBeCancelled) {
  const CutSurface s(some_angles(-1), 0);
  const GluingProblem problem = s.problem();
  Timings timings;
  const ProgressCallback stop = [](const Progress& progress) { return progress.iteration < 2; };
  EXPECT_THROW(curved_map(problem, {}, Stages(stop, timings)), Cancelled);
}

}  // namespace
}  // namespace orbitutte::curved_map_test
