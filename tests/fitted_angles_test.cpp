// SPDX-License-Identifier: MIT
#include "orbitutte/cones/fitted_angles.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <numbers>
#include <random>

#include "orbitutte/choose.h"
#include "orbitutte/cones/extremities.h"
#include "orbitutte/cones/fitted_cones.h"
#include "orbitutte/cones/marked_cones.h"
#include "orbitutte/embed.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/samples/sample.h"
#include "orbitutte/verify/distortion.h"
#include "orbitutte/weights/weights.h"
#include "test_meshes.h"

namespace orbitutte::fitted_angles_test {
namespace {

using std::numbers::pi;

/// A surface and its kernel.
struct Fitted {
  explicit Fitted(const Mesh& mesh)
      : surface(make_surface(mesh)),
        weights(edge_weights(surface, {})),
        kernel(surface, weights, available_backends().front()) {}

  std::vector<int> extremities(int count) const {
    const bool is_closed = surface.topology == Topology::sphere;
    return choose_extremities(surface, {is_closed ? count : 0, is_closed ? 0 : count});
  }

  CurvatureFit fit(const std::vector<int>& cones) const {
    return {kernel.potentials(cones)(cones, Eigen::all), kernel.even_potential()(cones),
            kernel.even_variance()};
  }

  Surface surface;
  EdgeWeights weights;
  ScaleKernel kernel;
};

const Fitted& figure() {
  static const Fitted fitted(sample_mesh({SampleShape::figure, 4000}));
  return fitted;
}

const Fitted& mask() {
  static const Fitted fitted(sample_mesh({SampleShape::mask, 3000}));
  return fitted;
}

Mesh divided(Mesh mesh, int times) {
  for (int k = 0; k < times; ++k) mesh = subdivided(mesh);
  return mesh;
}

// ---------------------------------------------------------------------------------------------- the kernel

TEST(ScaleKernel, PotentialsAreASymmetricPositiveKernel) {
  for (const Fitted* fitted : {&figure(), &mask()}) {
    const Eigen::MatrixXd gram = fitted->fit(fitted->extremities(12)).gram;
    EXPECT_LT((gram - gram.transpose()).cwiseAbs().maxCoeff(), 1e-10 * gram.cwiseAbs().maxCoeff());
    EXPECT_GT(Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(gram).eigenvalues().minCoeff(), 0);
  }
}

TEST(ScaleKernel, CurvaturesAddUpToTheEulerCharacteristic) {
  EXPECT_NEAR(figure().kernel.total_curvature(), 4 * pi, 1e-10);
  EXPECT_NEAR(mask().kernel.total_curvature(), 2 * pi, 1e-10);
}

TEST(ScaleKernel, BothBackendsAgree) {
  const std::vector<int> cones = mask().extremities(4);
  for (const Backend backend : available_backends()) {
    const ScaleKernel kernel(mask().surface, mask().weights, backend);
    EXPECT_LT((kernel.potentials(cones) - mask().kernel.potentials(cones)).cwiseAbs().maxCoeff(), 1e-9);
  }
}

// -------------------------------------------------------------------------------------------- least squares

struct Problem {
  CurvatureFit fit;
  CurvatureBounds bounds;
};

Problem random_problem(int count, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto vector = [&] { return Eigen::VectorXd::NullaryExpr(count, [&] { return uniform(random); }); };
  Eigen::MatrixXd root(count, count);
  for (double& entry : root.reshaped()) entry = uniform(random);
  Problem problem = {{root * root.transpose() + 0.01 * Eigen::MatrixXd::Identity(count, count), vector(), 9},
                     {Eigen::VectorXd::Constant(count, -0.3), Eigen::VectorXd::Constant(count, 0.4), {}}};
  if (seed % 2 == 0) problem.bounds.sum = 0.1 * uniform(random) * count;
  return problem;
}

// No curvature that moves from one cone to another, or, where the sum is free, none that is added, lowers
// sigma: for a convex problem that is the minimum.
TEST(LeastSigma, IsTheMinimumWithinTheBounds) {
  for (std::uint32_t seed = 0; seed < 200; ++seed) {
    const auto [fit, bounds] = random_problem(2 + static_cast<int>(seed % 9), seed);
    const Eigen::VectorXd x = least_sigma(fit, bounds);
    EXPECT_GE((x - bounds.least).minCoeff(), -1e-12);
    EXPECT_GE((bounds.greatest - x).minCoeff(), -1e-12);
    if (bounds.sum) EXPECT_NEAR(x.sum(), *bounds.sum, 1e-12);
    const Eigen::VectorXd slope = fit.gram * x - fit.pull;
    for (Eigen::Index i = 0; i < x.size(); ++i) {
      const bool may_grow = x[i]<bounds.greatest[i] - 1e-9, may_fall = x[i]> bounds.least[i] + 1e-9;
      if (!bounds.sum && may_grow) EXPECT_GE(slope[i], -1e-9) << seed;
      if (!bounds.sum && may_fall) EXPECT_LE(slope[i], 1e-9) << seed;
      for (Eigen::Index j = 0; bounds.sum && j < x.size(); ++j)
        if (may_grow && x[j] > bounds.least[j] + 1e-9) EXPECT_GE(slope[i] - slope[j], -1e-9) << seed;
    }
  }
}

// ------------------------------------------------------------------------------------------- fitted angles

// All of the curvature of a polyhedron is at its corners: its own metric is the best, whatever the mesh.
TEST(FittedAngles, OfAPolyhedronAreItsOwn) {
  const struct {
    Mesh polyhedron;
    double angle;
  } cases[] = {
      {test::tetrahedron(), pi}, {test::octahedron(), 4 * pi / 3}, {test::icosahedron(), 5 * pi / 3}};
  for (const auto& [polyhedron, angle] : cases) {
    const Fitted fitted(divided(polyhedron, 3));
    std::vector<int> corners(polyhedron.V.rows());
    for (std::size_t k = 0; k < corners.size(); ++k) corners[k] = static_cast<int>(k);
    const FittedAngles fit = fit_angles(fitted.kernel, corners);
    for (const double found : fit.angles) EXPECT_NEAR(found, angle, 1e-6);
    EXPECT_LT(fit.sigma, 1e-6);
    EXPECT_NEAR(fit.area, 0, 1e-9);
  }
}

// A flat sheet's corners are those of the target.
TEST(FittedAngles, OfAFlatTriangleAreItsOwn) {
  const Mesh sheet = divided(test::mesh({{0, 0, 0}, {3, 0, 0}, {1, 2, 0}}, {{0, 1, 2}}), 4);
  const FittedAngles fit = fit_angles(Fitted(sheet).kernel, {0, 1, 2});
  const double at_0 = std::atan2(2, 1), at_1 = std::atan2(2, 2);
  EXPECT_NEAR(fit.angles[0], at_0, 1e-6);
  EXPECT_NEAR(fit.angles[1], at_1, 1e-6);
  EXPECT_NEAR(fit.angles[2], pi - at_0 - at_1, 1e-6);
  EXPECT_LT(fit.sigma, 1e-6);
}

TEST(FittedAngles, HaveTheAreaOfGaussAndBonnetAndKeepTheirBounds) {
  for (const double area : {0.0, 0.5, -3.0}) {
    FitOptions options;
    options.area = area;
    options.least_angle = 0.3;
    const std::vector<int> cones = figure().extremities(8);
    const FittedAngles fit = fit_angles(figure().kernel, cones, options);
    double curvature = 0;
    for (const double angle : fit.angles) {
      curvature += 2 * pi - angle;
      EXPECT_GE(angle, 0.3 * 2 * pi - 1e-9);
      EXPECT_LE(angle, options.greatest() * 2 * pi + 1e-9);
    }
    EXPECT_NEAR(4 * pi - curvature, area, 1e-9);
    EXPECT_NEAR(fit.area, area, 1e-9);
  }
}

TEST(FittedAngles, AFreeAreaIsNoWorseThanAnyGivenOne) {
  const std::vector<int> cones = figure().extremities(6);
  const double best = fit_angles(figure().kernel, cones, {std::nullopt, 0.05, 0.99}).sigma;
  for (const double area : {-4.0, -1.0, 0.0, 1.0})
    EXPECT_LE(best, fit_angles(figure().kernel, cones, {area, 0.05, 0.99}).sigma + 1e-9);
}

// What the triangles around a cone get of the area of the map.
double share_around(const Embedding& map, int vertex) {
  double around = 0, all = 0;
  for (Eigen::Index f = 0; f < map.triangles.rows(); ++f) {
    const Vector3 a = map.positions.row(map.triangles(f, 0)), b = map.positions.row(map.triangles(f, 1)),
                  c = map.positions.row(map.triangles(f, 2));
    const double area = a.dot((b - a).cross(c - a));
    all += area;
    for (const int v : map.triangles.row(f))
      if (map.source_vertex[v] == vertex) around += area;
  }
  return around / all;
}

TEST(FittedAngles, SharesOfTheTargetAreThoseOfTheMap) {
  const std::vector<int> cones = figure().extremities(4);
  const std::vector<double> angles = {0.2 * pi, 0.4 * pi, 1.8 * pi, 1.6 * pi};
  Eigen::VectorXd curvatures(4);
  for (int k = 0; k < 4; ++k) curvatures[k] = 2 * pi - angles[k];
  const Eigen::VectorXd shares = figure().kernel.target_shares(cones, curvatures);
  const Embedding map =
      embed(figure().surface, marked_cones(figure().surface, "cones", cones, angles).target, cones).embedding;
  for (int k = 0; k < 2; ++k) {  // of a cone that takes much; the others have less than is seen
    const double around = share_around(map, cones[k]);
    EXPECT_GT(shares[k], 0.5 * around) << k;
    EXPECT_LT(shares[k], 2 * around) << k;
  }
}

// The triangles around no corner get more of the target than they may, unless sigma would grow too much.
TEST(FittedAngles, OfConesThatTakeTooMuchAreLarger) {
  const std::vector<int> corners = mask().extremities(3);
  const auto greatest_share = [&](const FittedAngles& fit) {
    Eigen::VectorXd curvatures(3);
    for (int k = 0; k < 3; ++k) curvatures[k] = pi - fit.angles[k];
    return mask().kernel.target_shares(corners, curvatures).maxCoeff();
  };
  FitOptions options;
  options.greatest_share = 1;
  options.greatest_excess = std::numeric_limits<double>::infinity();
  const FittedAngles least = fit_angles(mask().kernel, corners, options);
  options.greatest_share = 0.85 * greatest_share(least);
  options.sigma_for_shares = 1;
  const FittedAngles spared = fit_angles(mask().kernel, corners, options);
  EXPECT_LE(greatest_share(spared), options.greatest_share);
  EXPECT_GT(spared.sigma, least.sigma);
  options.sigma_for_shares = options.sigma_in_vain = 0.5 * (spared.sigma / least.sigma - 1);
  const FittedAngles between = fit_angles(mask().kernel, corners, options);
  EXPECT_LE(between.sigma, (1 + options.sigma_for_shares) * least.sigma);
  EXPECT_GT(greatest_share(between), options.greatest_share);
}

// What the triangles around a cone add to E/2A in the surface's own metric.
double excess_around(const Surface& surface, const Embedding& map, int vertex) {
  const std::vector<FaceDistortion> faces = measure_triangles(surface, map);
  double excess = 0;
  for (std::size_t f = 0; f < faces.size(); ++f)
    if ((surface.triangles.row(static_cast<Eigen::Index>(f)).array() == vertex).any())
      excess += faces[f].share * faces[f].area * ((faces[f].angle + 1 / faces[f].angle) / 2 - 1);
  return excess;
}

// The triangles around a cone stretch as little as they may, whatever sigma becomes.
TEST(FittedAngles, OfConesThatStretchTheirTrianglesAreLarger) {
  const Fitted coarse(sample_mesh({SampleShape::figure, 2000}));
  const std::vector<int> cones = coarse.extremities(8);
  const auto worst = [&](const FittedAngles& fit) {
    const MarkedCones marked = marked_cones(coarse.surface, "cones", cones, fit.angles);
    const Embedding map = embed(coarse.surface, marked.target, marked.vertices).embedding;
    double excess = 0;
    for (std::size_t k = 0; k < cones.size(); ++k)
      if (fit.angles[k] < pi) excess = std::max(excess, excess_around(coarse.surface, map, cones[k]));
    return excess;
  };
  FitOptions options;
  options.greatest_share = 1;
  options.greatest_excess = std::numeric_limits<double>::infinity();
  const FittedAngles least = fit_angles(coarse.kernel, cones, options);
  options.greatest_excess = worst(least) / 4;
  options.sigma_for_shares = 1;
  const FittedAngles spared = fit_angles(coarse.kernel, cones, options);
  EXPECT_LT(worst(spared), 2 * options.greatest_excess) << "as well as the Laplacian predicts it";
  EXPECT_GT(spared.sigma, least.sigma);
  EXPECT_GT(*std::min_element(spared.angles.begin(), spared.angles.end()),
            *std::min_element(least.angles.begin(), least.angles.end()));
}

// With three equal cones the target is the orbifold 333, onto which the surface can be mapped.
TEST(FittedAngles, ThePredictedSigmaIsWhatAMapToThatTargetHas) {
  const std::vector<int> cones = figure().extremities(3);
  const double predicted = figure().fit(cones).sigma(Eigen::VectorXd::Constant(3, 4 * pi / 3));
  const EmbedResult map = embed(figure().surface, parse_orbifold("333"), cones);
  EXPECT_NEAR(predicted, map.distortion.sigma, 0.03 * map.distortion.sigma);
}

TEST(FittedAngles, RefusesWhatCannotBe) {
  const ScaleKernel& kernel = figure().kernel;
  EXPECT_THROW(fit_angles(kernel, {1, 2}), MeshError) << "two cones have less curvature than 4 pi";
  EXPECT_THROW(fit_angles(kernel, {1, 2, 2}), MeshError);
  EXPECT_THROW(fit_angles(kernel, {1, 2, 1000000}), MeshError);
  EXPECT_NO_THROW(fit_angles(kernel, {1, 2, 3}));
}

// -------------------------------------------------------------------------------------------- their places

TEST(FittedCones, DistortLessThanExtremitiesAndLessTheMoreThereAre) {
  double last = 10;  // sigma
  for (const int count : {3, 5, 8}) {
    const FittedCones found = place_cones(figure().kernel, {count, {}, {}, {}});
    EXPECT_EQ(static_cast<int>(found.vertices.size()), count);
    EXPECT_EQ(found.fit.angles.size(), found.vertices.size());
    EXPECT_LT(found.fit.sigma, fit_angles(figure().kernel, figure().extremities(count)).sigma);
    EXPECT_NEAR(found.fit.sigma, fit_angles(figure().kernel, found.vertices).sigma, 1e-9);
    EXPECT_LT(found.fit.sigma, 0.9 * last);
    last = found.fit.sigma;
  }
}

TEST(FittedCones, KeptVerticesComeFirst) {
  const FittedCones found = place_cones(figure().kernel, {5, {}, {17, 99}, {}});
  ASSERT_EQ(found.vertices.size(), 5u);
  EXPECT_EQ(found.vertices[0], 17);
  EXPECT_EQ(found.vertices[1], 99);
}

TEST(FittedCones, AsFewAsReachAGivenSigma) {
  const double wanted = 0.5;
  const FittedCones found = place_cones(figure().kernel, {3, wanted, {}, {}});
  EXPECT_LE(found.fit.sigma, wanted);
  const int count = static_cast<int>(found.vertices.size());
  ASSERT_GT(count, 3);
  EXPECT_GT(place_cones(figure().kernel, {count - 2, {}, {}, {}}).fit.sigma, wanted);
  FitOptions convex;
  convex.greatest_angle = 0.99;
  EXPECT_THROW(place_cones(figure().kernel, {3, wanted, {}, convex}), MeshError) << "no more cones help";
}

TEST(FittedCones, DisksHaveThemOnTheirBoundaryAndInside) {
  const FittedCones found = place_cones(mask().kernel, {6, {}, {}, {}});
  double curvature = 0;
  for (std::size_t k = 0; k < found.vertices.size(); ++k)
    curvature += mask().kernel.flat_angle(found.vertices[k]) - found.fit.angles[k];
  EXPECT_NEAR(curvature, 2 * pi, 1e-9);
  EXPECT_LT(found.fit.sigma, fit_angles(mask().kernel, mask().extremities(6)).sigma);
}

TEST(FittedCones, OrdersAreThoseOfAnOrbifold) {
  const std::vector<int> cones = place_cones(figure().kernel, {6, {}, {}, {std::nullopt}}).vertices;
  const FittedAngles fit = fit_orders(figure().kernel, cones);
  for (const double angle : fit.angles) {
    const double order = 2 * pi / angle;
    EXPECT_NEAR(order, std::round(order), 1e-9);
    EXPECT_GE(order, 2 - 1e-9);
    EXPECT_LE(order, 12 + 1e-9);
  }
  EXPECT_GE(fit.sigma, fit_angles(figure().kernel, cones, {std::nullopt, 1e-9, 1}).sigma);
}

// ---------------------------------------------------------------------------------------------- their maps

bool says_what_was_taken(const EmbedResult& result) {
  return std::any_of(result.warnings.begin(), result.warnings.end(), [](const std::string& warning) {
    return warning.find("were taken") != std::string::npos;
  });
}

ConeWishes wishes_for(const std::vector<int>& kept) {
  ConeWishes wishes;
  wishes.kept = kept;
  wishes.count = static_cast<int>(kept.size());
  return wishes;
}

// On a mesh too coarse for 16 cones, milder angles are taken, and a warning says so.
TEST(FittedEmbedding, IsCertifiedWithMilderAnglesWhereItIsNotWithTheFirst) {
  const Fitted coarse(sample_mesh({SampleShape::figure, 600}));
  const ConeWishes wishes = wishes_for(coarse.extremities(16));
  const FittedCones found = find_cones(coarse.surface, wishes);
  const MarkedCones marked = marked_cones(coarse.surface, "cones", found.vertices, found.fit.angles);
  ASSERT_FALSE(embed(coarse.surface, marked.target, marked.vertices).certificate.bijective);
  const EmbedResult result = embed_fitted(coarse.surface, "cones", {wishes, found});
  EXPECT_TRUE(result.certificate.bijective);
  EXPECT_TRUE(says_what_was_taken(result));
  for (const ConeCopies& cone : result.embedding.cones) {
    EXPECT_TRUE(std::count(wishes.kept.begin(), wishes.kept.end(), cone.vertex)) << "places were given";
    EXPECT_LE(cone.mark.angle, 1.6 * 2 * pi + 1e-9);
  }
}

// Their sum is given, so that most milder choices are the first one again, and are not embedded once more. At
// last none is above a right angle.
TEST(FittedEmbedding, OfThreeCornersIsTriedOnceForEachChoice) {
  const std::string path = std::string(ORBITUTTE_SHARED_DIR) + "/meshes/hippocampus.off";
  if (!std::filesystem::exists(path)) GTEST_SKIP() << path << " is missing";
  const Surface surface = make_surface(to_triangle_mesh(read_mesh(path)));
  const ConeWishes wishes = wishes_for(choose_extremities(surface, {0, 3}));
  const FittedCones found = find_cones(surface, wishes);
  ASSERT_GT(*std::max_element(found.fit.angles.begin(), found.fit.angles.end()), 0.6 * pi);
  const EmbedResult result = embed_fitted(surface, "*cones", {wishes, found});
  EXPECT_TRUE(result.certificate.bijective);
  EXPECT_TRUE(says_what_was_taken(result));
  for (const ConeCopies& corner : result.embedding.cones) EXPECT_LE(corner.mark.angle, 0.5 * pi + 1e-9);
  const auto is_begun = [](const auto& timing) { return timing.first == "validate"; };
  EXPECT_EQ(std::count_if(result.timings.begin(), result.timings.end(), is_begun), 2);
}

TEST(FittedEmbedding, IsThatOfTheFirstConesWhereNothingIsWrongWithIt) {
  const ConeWishes wishes = wishes_for(figure().extremities(5));
  const FittedCones found = find_cones(figure().surface, wishes);
  const MarkedCones marked = marked_cones(figure().surface, "cones", found.vertices, found.fit.angles);
  const EmbedResult result = embed_fitted(figure().surface, "cones", {wishes, found});
  EXPECT_EQ(result.embedding.positions,
            embed(figure().surface, marked.target, marked.vertices).embedding.positions);
  EXPECT_FALSE(says_what_was_taken(result));
}

// The tip of an arm turns faces over. It is drawn to its centre by weights, so that only its neighbours move.
TEST(FittedEmbedding, OfTurnedTipsMovesTheirNeighboursAlone) {
  const Fitted coarse(sample_mesh({SampleShape::figure, 2000}));
  const std::vector<int> cones = coarse.extremities(6);
  FitOptions options;
  options.greatest_share = 1;
  options.greatest_excess = std::numeric_limits<double>::infinity();
  const MarkedCones marked =
      marked_cones(coarse.surface, "cones", cones, fit_angles(coarse.kernel, cones, options).angles);
  const EmbedResult result = embed(coarse.surface, marked.target, marked.vertices);
  ASSERT_TRUE(result.certificate.bijective);
  ASSERT_FALSE(result.moved_vertices.empty());
  std::vector<char> is_near(coarse.surface.vertex_count(), 0);
  for (const auto& [a, b] : coarse.surface.connectivity.edges)
    for (const int cone : cones)
      if (a == cone || b == cone) is_near[a] = is_near[b] = 1;
  for (const int v : result.moved_vertices) EXPECT_TRUE(is_near[v]) << v;
}

}  // namespace
}  // namespace orbitutte::fitted_angles_test
