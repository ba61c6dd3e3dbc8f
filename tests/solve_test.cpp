// SPDX-License-Identifier: MIT
// The steps between the cut mesh and the minimum: gluing, energy, linear systems, start, optimiser.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cmath>
#include <numbers>
#include <numeric>

#include "orbitutte/solve/ears.h"
#include "orbitutte/solve/laplacian_systems.h"
#include "orbitutte/solve/lbfgs.h"
#include "solve_cases.h"

namespace orbitutte::solve_test {
namespace {

using test::moved;
using test::random_feasible;
using test::solve_case;
using test::SolveCase;

class EveryFamily : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Solve, EveryFamily, testing::ValuesIn(test::all_signatures()), [](const auto& info) {
  std::string name = info.param;
  if (const std::size_t at = name.find('*'); at != std::string::npos) name.replace(at, 1, "star");
  return name;
});

Points feasible_positions(const SolveCase& c, std::uint32_t seed) {
  const LaplacianSolver laplacian(c.cut, c.glued, c.weights, c.boundary);
  const Points start = initial_embedding(test::unjudged(c.mesh), c.cut, c.tile, c.boundary, laplacian);
  return moved(c, start, 0.02, random_feasible(c, seed));
}

// May the vertex move in all directions?
bool is_free(const SolveCase& c, int v) { return c.boundary.basis_of[v] == in_space; }

// --- boundary conditions

TEST_P(EveryFamily, SeamsTakeFeasiblePositionsOfOneBankToTheOther) {
  const auto c = solve_case(GetParam());
  const Points all = c->boundary.spread(feasible_positions(*c, 1), c->cut.source_vertex);
  for (const Seam& seam : c->boundary.seams) {
    for (std::size_t k = 0; k < seam.left.size(); ++k) {
      const Vector3 left = all.row(seam.left[k]), right = all.row(seam.right[k]);
      EXPECT_LT((left - seam.transform * right).norm(), 1e-14);
    }
  }
}

TEST_P(EveryFamily, EveryBoundaryEdgeLiesInOneBank) {
  const auto c = solve_case(GetParam());
  std::size_t edges = 0;
  for (const Seam& seam : c->boundary.seams)
    edges += (seam.left.size() - 1) * (seam.left == seam.right ? 1 : 2);
  EXPECT_EQ(edges, c->cut.boundary.size());
}

TEST_P(EveryFamily, ConesAreHeldAtTheTilesCornersAndNothingElseIs) {
  const auto c = solve_case(GetParam());
  for (int v = 0; v < test::vertex_count(c->mesh); ++v) {
    // The end of the cut chooses a rotation about the axis where no corner is marked on the mirror.
    const bool marked = std::count(c->marks.begin(), c->marks.end(), v) > 0 ||
                        (c->marks.size() == 1 && v == c->cut.marks.back());
    EXPECT_EQ(c->boundary.basis(v).cols() == 0, marked) << v;
    const Vector3 held = c->boundary.held.row(v);
    EXPECT_NEAR(marked ? c->boundary.space.defect(held) : held.norm(), 0, 1e-15);
  }
}

// --- energy

TEST_P(EveryFamily, GradientAgreesWithDifferencesOfTheEnergy) {
  const auto c = solve_case(GetParam());
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Points x = feasible_positions(*c, 2), direction = random_feasible(*c, 3);
  const double h = 1e-5;
  const auto energy_at = [&](double t) { return energy.evaluate(moved(*c, x, t, direction)).energy; };
  const double difference = (energy_at(h) - energy_at(-h)) / (2 * h);
  const double slope = energy.evaluate(x).gradient.cwiseProduct(direction).sum();
  EXPECT_NEAR(slope, difference, 1e-7 * (1 + std::abs(slope)));
}

TEST_P(EveryFamily, EnergyIsTheSumOfSquaredDistances) {
  const auto c = solve_case(GetParam());
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Points x = feasible_positions(*c, 4);
  const bool is_round = c->boundary.space == Space::sphere();
  double expected = 0;
  for (std::size_t e = 0; e < c->glued.edges.size(); ++e) {
    const auto [i, j, t] = c->glued.edges[e];
    const Vector3 p = x.row(i), q = c->glued.transforms[t] * Vector3(x.row(j));
    const double d =
        is_round ? std::atan2(p.cross(q).norm(), p.dot(q)) : std::hypot(p.x() - q.x(), p.y() - q.y());
    expected += c->weights.w[static_cast<Eigen::Index>(e)] * d * d;
  }
  EXPECT_NEAR(energy.evaluate(x).energy, expected, 1e-13 * expected);
}

TEST_P(EveryFamily, GradientIsTangentialAndFeasible) {
  const auto c = solve_case(GetParam());
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Points x = feasible_positions(*c, 5), g = energy.evaluate(x).gradient;
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Room& room = c->boundary.basis(static_cast<int>(v));
    const Vector3 here = g.row(v);
    EXPECT_LT((here - room * (room.transpose() * here)).norm(), 1e-13);
    EXPECT_LT((c->boundary.space.tangent(x.row(v), here) - here).norm(), 1e-13);
  }
}

TEST_P(EveryFamily, EnergyDoesNotKnowWhereTheCutRuns) {
  const auto first = solve_case(GetParam());
  const LaplacianSolver laplacian(first->cut, first->glued, first->weights, first->boundary);
  const DirichletEnergy energy(first->glued, first->weights, first->boundary);
  const Minimum one = minimize(
      energy, laplacian,
      initial_embedding(test::unjudged(first->mesh), first->cut, first->tile, first->boundary, laplacian));
  const auto second = solve_case(GetParam(), {5});
  const LaplacianSolver other(second->cut, second->glued, second->weights, second->boundary);
  const DirichletEnergy other_energy(second->glued, second->weights, second->boundary);
  const Minimum two = minimize(
      other_energy, other,
      initial_embedding(test::unjudged(second->mesh), second->cut, second->tile, second->boundary, other));
  EXPECT_NEAR(one.energy, two.energy, 1e-12 * one.energy);
}

// --- linear systems

// Solutions are this exact: their factor is in single precision.
constexpr double single_precision = 2e-5;

TEST_P(EveryFamily, PreconditionerInvertsTwiceTheGluedLaplacian) {
  const auto c = solve_case(GetParam());
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const Points x = random_feasible(*c, 6);
  // 2 L x in the room of every vertex, edge by edge.
  Points Lx = Points::Zero(x.rows(), 3);
  for (std::size_t e = 0; e < c->glued.edges.size(); ++e) {
    const auto [i, j, t] = c->glued.edges[e];
    const Isometry& g = c->glued.transforms[t];
    const Vector3 difference = Vector3(x.row(i)) - g * Vector3(x.row(j));
    Lx.row(i) += 2 * c->weights.w[e] * difference;
    Lx.row(j) -= 2 * c->weights.w[e] * (g.inverse() * difference);
  }
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Room& room = c->boundary.basis(static_cast<int>(v));
    Lx.row(v) = room * (room.transpose() * Vector3(Lx.row(v)));
  }
  EXPECT_LT((laplacian.precondition(Lx) - x).cwiseAbs().maxCoeff(), single_precision);
}

TEST_P(EveryFamily, HarmonicExtensionGivesEveryInnerVertexTheMeanOfItsNeighbours) {
  const auto c = solve_case(GetParam());
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const Points given = random_feasible(*c, 9), x = laplacian.extend_harmonically(given);
  Points pull = Points::Zero(x.rows(), 3);
  for (std::size_t e = 0; e < c->glued.edges.size(); ++e) {
    const auto [i, j, t] = c->glued.edges[e];
    const Isometry& g = c->glued.transforms[t];
    const Vector3 difference = g * Vector3(x.row(j)) - Vector3(x.row(i));
    pull.row(i) += c->weights.w[e] * difference;
    pull.row(j) -= c->weights.w[e] * (g.inverse() * difference);
  }
  for (const int v : c->cut.boundary) {
    const int source = c->cut.source_vertex[v];
    EXPECT_EQ(x.row(source), given.row(source));
    pull.row(source).setZero();
  }
  EXPECT_LT(pull.cwiseAbs().maxCoeff(), single_precision);
}

void expect_both_ways_solve_alike(const SolveCase& c) {
  const Dissection dissection = dissect(vertex_neighbors(c.connectivity.edges, test::vertex_count(c.mesh)));
  const DiskGraph graph = disk_graph(c.cut, c.glued, c.boundary);
  const LaplacianProblem problem = {graph, c.glued, c.weights.w, c.boundary, dissection};
  const Points f = random_feasible(c, 8), g = Points::Random(graph.node_count(), 3);
  const auto coupled = coupled_systems(problem, available_backends().front());
  for (const Backend backend : available_backends()) {
    LaplacianReuse reuse;
    const auto banked = banked_systems(problem, {backend}, reuse);
    EXPECT_LT((banked->solve_glued(f) - coupled->solve_glued(f)).cwiseAbs().maxCoeff(), single_precision)
        << name_of(backend);
    EXPECT_LT((banked->solve_disk(g) - coupled->solve_disk(g)).cwiseAbs().maxCoeff(), single_precision)
        << name_of(backend);
  }
}

TEST_P(EveryFamily, OneFactorisationWithTheBanksLastSolvesBothSystems) {
  expect_both_ways_solve_alike(*solve_case(GetParam()));
}

// Another frame on a part of the mesh: edges between vertices inside are no longer the identity.
TEST_P(EveryFamily, EdgesAcrossTheCutBetweenVerticesInsideAreSolvedAsWell) {
  const auto c = solve_case(GetParam());
  const Isometry turn = c->boundary.space.rotation(c->boundary.space.retract({1, 2, 3}), 0.4);
  for (GluedEdge& edge : c->glued.edges) {
    const auto turned = [&](int v) { return c->mesh.V(v, 0) > 0 && is_free(*c, v); };
    if (turned(edge.i) == turned(edge.j)) continue;
    const Isometry& g = c->glued.transforms[edge.t];
    const Isometry g_turned = turned(edge.i) ? turn.inverse() * g : g * turn;
    edge.t = index_among(c->glued.transforms, g_turned);
  }
  const DiskGraph graph = disk_graph(c->cut, c->glued, c->boundary);
  EXPECT_GT(std::count(graph.inside.begin(), graph.inside.end(), 1), 20);
  for (std::size_t e = 0; e < graph.ends.size(); ++e) {
    const auto [a, b] = graph.ends[e];
    const auto [i, j, t] = c->glued.edges[e];
    const Isometry between = graph.transform(a).inverse() * graph.transform(b);
    EXPECT_LT(between.difference(c->glued.transforms[t]), 1e-9);
    EXPECT_EQ(graph.vertex[a], i);
    EXPECT_EQ(graph.vertex[b], j);
  }
  expect_both_ways_solve_alike(*c);
}

TEST(LaplacianSolver, BoundariesThatAreLongBesideTheMeshAreSolvedAsWell) {
  const Mesh strip = test::grid_disk(400, 1);  // every vertex is on the boundary
  const EmbedResult result = embed(strip, parse_orbifold("*432"), {0, 200, 600});
  EXPECT_EQ(result.minimum.termination, Termination::converged);
}

TEST(DirichletEnergy, TheSmallestSpotIsAtTheShortestEdge) {
  const auto c = solve_case("432");
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  Points positions = feasible_positions(*c, 30);
  EXPECT_GT(energy.smallest_spot(positions).second, 1e-6);
  int v = 0;
  while (!is_free(*c, v) || c->glued.edges[v].t != 0 || !is_free(*c, c->glued.edges[v].j)) ++v;
  const auto [i, j, t] = c->glued.edges[v];
  positions.row(j) = positions.row(i);
  positions(j, 0) += 1e-9;
  const auto [vertex, length] = energy.smallest_spot(positions);
  EXPECT_TRUE(vertex == i || vertex == j);
  EXPECT_NEAR(length, 1e-9, 1e-15);
}

// A mesh of several blocks, embedded whole and in parts.
TEST(LaplacianSolver, BlocksOfAnySizeSolveTheSameSystem) {
  const Mesh sphere = test::perturbed(test::icosphere(5), 0.01, 3);
  const std::vector<int> marks = choose_cones(sphere, parse_orbifold("432"));
  EmbedOptions whole, parts;
  whole.laplacian.block_size = 100000;
  parts.laplacian.block_size = 1000;
  const EmbedResult one = embed(sphere, parse_orbifold("432"), marks, whole),
                    many = embed(sphere, parse_orbifold("432"), marks, parts);
  EXPECT_EQ(one.minimum.iterations, many.minimum.iterations);
  EXPECT_LT((one.minimum.positions - many.minimum.positions).cwiseAbs().maxCoeff(), 1e-11);
}

TEST(LaplacianSolver, NamesAVertexThatNoPositiveWeightHolds) {
  const auto c = solve_case("432");
  int loose = 0;
  while (std::count(c->marks.begin(), c->marks.end(), loose) ||
         std::count(c->cut.boundary.begin(), c->cut.boundary.end(), loose))
    ++loose;
  for (std::size_t e = 0; e < c->glued.edges.size(); ++e)
    if (c->glued.edges[e].i == loose || c->glued.edges[e].j == loose)
      c->weights.w[static_cast<Eigen::Index>(e)] = 0;
  try {
    const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary,
                                    {available_backends().front()});
    FAIL();
  } catch (const MeshError& error) {
    EXPECT_NE(std::string(error.what()).find("no positive weights tie"), std::string::npos) << error.what();
  }
}

// --- start and optimiser

TEST_P(EveryFamily, StartIsInTheSpaceAndFeasible) {
  const auto c = solve_case(GetParam());
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const Points start = initial_embedding(test::unjudged(c->mesh), c->cut, c->tile, c->boundary, laplacian);
  for (Eigen::Index v = 0; v < start.rows(); ++v) {
    EXPECT_LT(c->boundary.space.defect(start.row(v)), 1e-15);
    const Isometry& mirror = c->boundary.mirrors[c->boundary.basis_of[v]];
    const Vector3 here = start.row(v);
    const Vector3 expected =
        c->boundary.basis_of[v] == held_in_place ? Vector3(c->boundary.held.row(v)) : mirror * here;
    EXPECT_LT((here - expected).norm(), 2e-15);
  }
}

TEST_P(EveryFamily, OptimiserConvergesWithEnergyThatNeverRises) {
  const auto c = solve_case(GetParam());
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Minimum minimum = minimize(
      energy, laplacian, initial_embedding(test::unjudged(c->mesh), c->cut, c->tile, c->boundary, laplacian));
  EXPECT_EQ(minimum.termination, Termination::converged);
  EXPECT_LE(minimum.gradient_norm, 1e-9);
  EXPECT_LE(minimum.iterations, 60);
  ASSERT_EQ(static_cast<int>(minimum.history.size()), minimum.iterations + 1);
  for (std::size_t k = 1; k < minimum.history.size(); ++k)
    EXPECT_LE(minimum.history[k].energy, minimum.history[k - 1].energy * (1 + 1e-13));
  // No point nearby has less energy.
  for (std::uint32_t seed = 10; seed < 14; ++seed) {
    const Points nearby = moved(*c, minimum.positions, 1e-3, random_feasible(*c, seed));
    EXPECT_GT(energy.evaluate(nearby).energy, minimum.energy);
  }
}

TEST_P(EveryFamily, MinimumDoesNotDependOnTheStart) {
  const auto c = solve_case(GetParam());
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Minimum one = minimize(
      energy, laplacian, initial_embedding(test::unjudged(c->mesh), c->cut, c->tile, c->boundary, laplacian));
  const Minimum two = minimize(energy, laplacian, feasible_positions(*c, 20));
  EXPECT_NEAR(one.energy, two.energy, 1e-12 * one.energy);
}

// Where a step ends that lowers the energy by far, the Hessian is another: what follows is as if it began
// there.
TEST(Lbfgs, StepsFromFarAreNotRememberedAndOthersAre) {
  const auto c = solve_case("432");
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Points start = feasible_positions(*c, 20);
  const Minimum whole = minimize(energy, laplacian, start);
  const auto steps_of_a_fresh_start_after = [&](int iterations) {
    LbfgsOptions options;
    options.max_iterations = iterations;
    const Minimum rest = minimize(energy, laplacian, minimize(energy, laplacian, start, options).positions);
    std::vector<double> steps;
    for (std::size_t k = 1; k < rest.history.size(); ++k) steps.push_back(rest.history[k].step);
    return steps;
  };
  std::size_t first_near = 1;
  while (whole.history[first_near].energy < 0.99 * whole.history[first_near - 1].energy) ++first_near;
  ASSERT_GT(first_near, 1U);
  ASSERT_LT(first_near + 3, whole.history.size());
  const std::vector<double> afresh = steps_of_a_fresh_start_after(static_cast<int>(first_near) - 1);
  ASSERT_EQ(afresh.size(), whole.history.size() - first_near);
  for (std::size_t k = 0; k < afresh.size(); ++k) EXPECT_EQ(afresh[k], whole.history[first_near + k].step);
  const std::vector<double> forgetful = steps_of_a_fresh_start_after(static_cast<int>(first_near));
  EXPECT_GT(forgetful[1], whole.history[first_near + 2].step);
}

// The preconditioner inverts the Hessian but for 2/(l(l + 1)) of the spherical harmonics of degree l that the
// group leaves as they are: l is at least 4 here.
TEST(Lbfgs, StepsNearTheMinimumLeaveLittle) {
  for (const char* signature : {"532", "432", "*532", "*432"}) {
    const auto c = solve_case(signature);
    const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
    const DirichletEnergy energy(c->glued, c->weights, c->boundary);
    const Points minimum = minimize(energy, laplacian, feasible_positions(*c, 20)).positions;
    const Points start = moved(*c, minimum, 1e-3, random_feasible(*c, 11));
    const Minimum back = minimize(energy, laplacian, start);
    ASSERT_GE(back.history.size(), 4U);
    for (std::size_t k = 2; k < back.history.size(); ++k)
      EXPECT_LT(back.history[k].step, 0.12 * back.history[k - 1].step) << signature << ' ' << k;
  }
}

// With weights so large that rounding hides the tolerance, the last step is one that brought little.
TEST(Lbfgs, StiffWeightsAreFollowedAsLongAsGradientsFall) {
  for (const char* signature : {"532", "432", "*532", "*432"}) {
    const auto c = solve_case(signature);
    EdgeWeights stiff = c->weights;
    stiff.w *= 1e9;
    const LaplacianSolver laplacian(c->cut, c->glued, stiff, c->boundary);
    const DirichletEnergy energy(c->glued, stiff, c->boundary);
    const Minimum minimum = minimize(energy, laplacian, feasible_positions(*c, 20));
    EXPECT_EQ(minimum.termination, Termination::converged);
    const double last = minimum.history.back().gradient_norm,
                 before = minimum.history[minimum.history.size() - 2].gradient_norm;
    EXPECT_GT(last, LbfgsOptions().tolerance);
    EXPECT_GE(last, 0.5 * before) << signature;
  }
}

TEST(Lbfgs, OptionsOutOfRangeAreRefused) {
  const auto c = solve_case("432");
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const Points start = initial_embedding(test::unjudged(c->mesh), c->cut, c->tile, c->boundary, laplacian);
  LbfgsOptions tolerance, iterations, memory;
  tolerance.tolerance = 0;
  iterations.max_iterations = -1;
  memory.memory = 0;
  for (const LbfgsOptions& options : {tolerance, iterations, memory})
    EXPECT_THROW(minimize(energy, laplacian, start, options), ArgumentError);
}

TEST(Lbfgs, EndsAtTheLastIterationAllowedAndSaysSo) {
  const auto c = solve_case("432");
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  LbfgsOptions options;
  options.max_iterations = 2;
  const Minimum minimum =
      minimize(energy, laplacian,
               initial_embedding(test::unjudged(c->mesh), c->cut, c->tile, c->boundary, laplacian), options);
  EXPECT_EQ(minimum.iterations, 2);
  EXPECT_EQ(minimum.termination, Termination::max_iterations);
}

// --- ears

TEST(Ears, TriangleWithTwoEdgesOnAMirrorIsFoundAndRoundedOutward) {
  Mesh mesh = test::grid_disk(
      6, 6);  // its corners 6 and 42 are tips of ears, 0 and 48 are not, whichever way diagonals run
  const Target orbifold = parse_orbifold("*22");
  const std::vector<int> marks = {3, 45};
  const CutMesh cut = cut_to_disk(test::unjudged(mesh), marks, 0);
  const Tile tile = basic_tile(orbifold, cut.arrangement);
  const BoundaryConditions boundary = glue(cut, tile, orbifold);
  const std::vector<Ear> ears = find_ears(FaceView(cut.F), tile, boundary);
  ASSERT_EQ(ears.size(), 2u);
  const EmbedResult result = embed(mesh, orbifold, marks);
  EXPECT_TRUE(result.certificate.bijective);
  ASSERT_EQ(result.warnings.size(), 1u);
  EXPECT_NE(result.warnings[0].find("2 faces"), std::string::npos);
}

}  // namespace
}  // namespace orbitutte::solve_test
