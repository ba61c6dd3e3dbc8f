// SPDX-License-Identifier: MIT
#include "orbitutte/verify/theorem2.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <map>
#include <numbers>
#include <random>

#include "hand_made.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/solve/lbfgs.h"
#include "sample_embeddings.h"
#include "solve_cases.h"

namespace orbitutte::theorem2_test {
namespace {

using Eigen::VectorXd;
using std::numbers::pi;
using testing::HasSubstr;
using Status = Theorem2::Status;

Theorem2 theorem2_of(const Mesh& mesh, const EdgeWeights& weights, const Embedding& embedding,
                     const Theorem2Options& options = {}) {
  return check_theorem2(test::unjudged(mesh), weights, embedding, options);
}

Theorem2 theorem2_of(const test::SampleEmbedding& sample, const Theorem2Options& options = {}) {
  return theorem2_of(sample.mesh, sample.result.weights, sample.embedding(), options);
}

TEST(Theorem2, HoldsForTheSamplesOfAllFamilies) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Theorem2 theorem2 = theorem2_of(sample);
    EXPECT_EQ(name_of(theorem2.status), "measured") << signature << ": " << theorem2.detail;
    EXPECT_EQ(theorem2.negative, 1) << signature;
    EXPECT_EQ(theorem2.kernel, 3) << signature;
    EXPECT_LT(theorem2.kernel_residual, 1e-6) << signature;
    EXPECT_DOUBLE_EQ(theorem2.max_edge_length, sample.result.certificate.max_edge_length) << signature;
    EXPECT_EQ(theorem2.holds(), theorem2.max_edge_length < pi / 2) << signature;
  }
}

// Weights of edges that cross the cut, and are no edges of the mesh.
TEST(Theorem2, HoldsForIntrinsicWeights) {
  EmbedOptions options;
  options.threads = 1;
  options.weights.kind = WeightKind::delaunay;
  std::size_t flips = 0;
  for (const char* signature : {"532", "33", "225", "*432", "*22", "3*2", "5*", "1x", "3x"}) {
    const test::SampleEmbedding sample = test::make_sample(signature, options);
    flips += sample.result.weights.triangulation->flips.size();
    const Theorem2 theorem2 =
        check_theorem2(test::unjudged(sample.mesh), sample.result.weights, sample.embedding());
    EXPECT_EQ(name_of(theorem2.status), "measured") << signature << ": " << theorem2.detail;
    EXPECT_EQ(theorem2.negative, 1) << signature;
    EXPECT_EQ(theorem2.kernel, 3) << signature;
    EXPECT_LT(theorem2.kernel_residual, 1e-6) << signature;
  }
  EXPECT_GT(flips, 0u);
}

TEST(Theorem2, IsNotRunWhereTheGroupIsNotFinite) {
  for (const char* signature : {"442", "2222", "*632", "*2222"}) {
    const Theorem2 theorem2 = theorem2_of(test::sample_embedding(signature));
    EXPECT_EQ(theorem2.status, Status::not_run) << signature;
    EXPECT_THAT(theorem2.detail, HasSubstr(std::string(signature) + " has none"));
    EXPECT_FALSE(theorem2.holds());
  }
  const Target cones = cone_target(Topology::sphere, std::vector<Mark>(3, Mark{pi, ConeKind::rotation}));
  EXPECT_THAT(reason_without_theorem2(cones), HasSubstr("not for cones of given angles"));
  EXPECT_EQ(reason_without_theorem2(parse_orbifold("222")), "");
}

TEST(Theorem2, EveryMethodCountsTheSame) {
  for (const InertiaMethod method : available_inertia_methods()) {
    for (const char* signature : {"532", "33", "*432", "*22", "3*2", "5*"}) {
      Theorem2Options options;
      options.method = method;
      const Theorem2 theorem2 = theorem2_of(test::sample_embedding(signature), options);
      EXPECT_EQ(theorem2.status, Status::measured) << signature << " " << name_of(method);
      EXPECT_EQ(theorem2.negative, 1) << signature << " " << name_of(method);
      EXPECT_EQ(theorem2.kernel, 3) << signature << " " << name_of(method);
    }
  }
}

TEST(Theorem2, TheWeightsMayComeInAnyUnit) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  for (const double factor : {1e-6, 1e6}) {
    EdgeWeights weights = sample.result.weights;
    weights.w *= factor;
    const Theorem2 theorem2 = theorem2_of(sample.mesh, weights, sample.embedding());
    EXPECT_TRUE(theorem2.holds()) << factor << ": " << theorem2.detail;
  }
}

// The second way: the cover welded by weld_copies, and W on it as one matrix

std::array<int, 2> undirected(int i, int j) { return {std::min(i, j), std::max(i, j)}; }

// By source edge. On the cover an edge on a mirror has the halves of both its sides.
std::map<std::array<int, 2>, double> cover_weights(const Mesh& mesh, const EdgeWeights& weights) {
  const Connectivity connectivity = test::edges_of(mesh);
  std::map<std::array<int, 2>, double> result;
  for (std::size_t e = 0; e < connectivity.edges.size(); ++e) result[connectivity.edges[e]] = weights.w[e];
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h)
    if (connectivity.opposite[h] < 0) result[connectivity.edges[connectivity.edge_of[h]]] *= 2;
  return result;
}

VectorXd vertex_areas(const Mesh& sphere) {
  VectorXd area = VectorXd::Zero(sphere.V.rows());
  for (int f = 0; f < sphere.F.rows(); ++f) {
    const auto v = sphere.F.row(f);
    const double third = Space::sphere().area(sphere.V.row(v[0]), sphere.V.row(v[1]), sphere.V.row(v[2])) / 3;
    for (int k = 0; k < 3; ++k) area[v[k]] += third;
  }
  return area;
}

struct WholeCover {
  SymmetricMatrix W;
  VectorXd scale;
};

WholeCover whole_cover(const Mesh& mesh, const EdgeWeights& weights, const Embedding& embedding) {
  const Tiling tiling = weld_copies(embedding);
  const std::map<std::array<int, 2>, double> weight_of = cover_weights(mesh, weights);
  const int n = test::vertex_count(tiling.mesh);
  std::vector<Eigen::Triplet<double>> entries;
  VectorXd diagonal = VectorXd::Zero(n), couplings = VectorXd::Zero(n);
  double energy = 0;
  for (const auto& [i, j] : test::edges_of(tiling.mesh).edges) {
    const Vector3 p = tiling.mesh.V.row(i), q = tiling.mesh.V.row(j);
    const double d = std::atan2(p.cross(q).norm(), p.dot(q));
    const double w = weight_of.at(undirected(tiling.source_vertex[i], tiling.source_vertex[j]));
    entries.emplace_back(std::max(i, j), std::min(i, j), -w * d / std::sin(d));
    energy += w * d * d;
    for (const int v : {i, j}) {
      diagonal[v] += w * d * p.dot(q) / std::sin(d);
      couplings[v] += w * d / std::sin(d);
    }
  }
  for (int v = 0; v < n; ++v) entries.emplace_back(v, v, diagonal[v]);
  const VectorXd area = vertex_areas(tiling.mesh);
  WholeCover result = {SymmetricMatrix(n, n), energy / (2 * area.sum()) * area + 1e-12 * couplings};
  result.W.setFromTriplets(entries.begin(), entries.end());
  return result;
}

EdgeWeights shuffled(EdgeWeights weights, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> factor(0.2, 5);
  for (double& w : weights.w) w *= factor(random);
  return weights;
}

// Other weights than the map's own, so that spectra have nothing special about them; shifts up to where many
// eigenvalues lie below.
TEST(Theorem2, RepresentationsTogetherCountWhatTheWholeCoverHas) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const EdgeWeights weights = shuffled(sample.result.weights, 3);
    const WholeCover whole = whole_cover(sample.mesh, weights, sample.embedding());
    const auto counter = inertia_counter(whole.W, whole.scale, InertiaMethod::eigen);
    for (const double shift : {-1.0, -0.1, 0.2, 3.0, 9.0, 50.0})
      EXPECT_EQ(cover_eigenvalues_below(test::unjudged(sample.mesh), weights, sample.embedding(), shift),
                counter->eigenvalues_below(shift))
          << signature << " " << shift;
  }
}

TEST(Theorem2, RotatingTheSphereChangesNothing) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    std::mt19937 random(5);
    for (int k = 0; k < 3; ++k) {
      std::normal_distribution<double> normal;
      const Vector3 axis = Vector3(normal(random), normal(random), normal(random)).normalized();
      const Isometry M = Space::sphere().rotation(axis, normal(random));
      Embedding turned = sample.embedding();
      turned.placement = M * turned.placement;
      turned.positions = M.on_rows(turned.positions).rowwise().normalized();
      for (Seam& seam : turned.seams) seam.transform = M * seam.transform * M.inverse();
      const Theorem2 theorem2 = theorem2_of(sample.mesh, sample.result.weights, turned);
      EXPECT_EQ(theorem2.negative, 1) << signature;
      EXPECT_EQ(theorem2.kernel, 3) << signature;
    }
  }
}

// Planted faults

// A point turned about the z axis so that its longitude, measured from the meridian of `middle`, is doubled.
Vector3 doubled_longitude(const Vector3& p, const Vector3& middle) {
  const double from = std::atan2(middle.y(), middle.x());
  double longitude = std::atan2(p.y(), p.x()) - from;
  longitude -= 2 * pi * std::round(longitude / (2 * pi));
  return hand_made::rotation(Vector3::UnitZ(), longitude) * p;
}

// The lune of NN opened to twice its angle: its N copies go around the axis twice.
Tile opened(const Tile& tile) {
  const Vector3 middle = tile.centroid();
  Tile result = tile;
  for (TileSide& side : result.sides) {
    side.direction = doubled_longitude(side.direction, middle);
    side.transform = side.transform * side.transform;
  }
  return result;
}

struct DoubleCover {
  std::unique_ptr<test::SolveCase> of;
  Minimum minimum;
  Embedding embedding;
};

// A harmonic map of degree two.
DoubleCover double_cover(const std::string& signature) {
  DoubleCover result = {test::solve_case(signature), {}, {}};
  test::SolveCase& of = *result.of;
  const LaplacianSolver simple(of.cut, of.glued, of.weights, of.boundary);
  Points start = initial_embedding(test::unjudged(of.mesh), of.cut, of.tile, of.boundary, simple);
  for (Eigen::Index v = 0; v < start.rows(); ++v)
    start.row(v) = doubled_longitude(start.row(v), of.tile.centroid()).transpose();
  of.tile = opened(of.tile);
  of.boundary = glue(of.cut, of.tile, of.orbifold);
  of.glued = glued_edges(of.cut, of.connectivity, of.boundary);
  const LaplacianSolver laplacian(of.cut, of.glued, of.weights, of.boundary);
  result.minimum = minimize(DirichletEnergy(of.glued, of.weights, of.boundary), laplacian, start);
  result.embedding = {of.orbifold,
                      {},
                      of.boundary.spread(result.minimum.positions, of.cut.source_vertex),
                      of.cut.F,
                      of.cut.source_vertex,
                      of.boundary.seams,
                      of.boundary.cones,
                      {}};
  return result;
}

// The sphere's functions on the double cover begin with those of degree 0, 1/2 (two of them) and 1 (three),
// and Laplacian + 2 is positive on the first three.
TEST(Theorem2, ADoubleCoverHasTwoMoreNegativeEigenvalues) {
  for (const char* signature : {"33", "55"}) {
    const DoubleCover planted = double_cover(signature);
    ASSERT_EQ(planted.minimum.termination, Termination::converged) << signature;
    const Theorem2 theorem2 =
        check_theorem2(test::unjudged(planted.of->mesh), planted.of->weights, planted.embedding);
    EXPECT_EQ(theorem2.status, Status::measured) << signature << ": " << theorem2.detail;
    EXPECT_EQ(theorem2.negative, 3) << signature;
    EXPECT_EQ(theorem2.kernel, 3) << signature;
    EXPECT_LT(theorem2.kernel_residual, 1e-6) << signature;
    EXPECT_FALSE(theorem2.holds()) << signature;
    const Certificate certificate = certify(test::unjudged(planted.of->mesh), planted.embedding);
    EXPECT_NEAR(certificate.signed_area, 2 * certificate.expected_area, 1e-9) << signature;
    EXPECT_TRUE(certificate.nonpositive_faces.empty())
        << signature;  // no triangle shows that it is no bijection
  }
}

TEST(Theorem2, LongEdgesAreSeen) {
  const test::SampleEmbedding& sample = test::sample_embedding("22");
  Embedding embedding = sample.embedding();
  const int v = embedding.cones[0].vertex;
  for (int h = 0; h < static_cast<int>(embedding.triangles.size()); ++h)
    if (halfedge_origin(embedding.triangles, h) == v)
      embedding.positions.row(halfedge_target(embedding.triangles, h)) = -0.999 * embedding.positions.row(v);
  const Theorem2 theorem2 = theorem2_of(sample.mesh, sample.result.weights, embedding);
  EXPECT_FALSE(theorem2.checks().front().passed);
  EXPECT_THAT(theorem2.checks().front().detail, HasSubstr("pi/2"));
}

TEST(Theorem2, AMapThatIsNotStationaryIsInconclusive) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  const Theorem2 theorem2 = theorem2_of(sample.mesh, shuffled(sample.result.weights, 1), sample.embedding());
  EXPECT_EQ(theorem2.status, Status::inconclusive);
  EXPECT_THAT(theorem2.detail, HasSubstr("kernel"));
  EXPECT_FALSE(theorem2.holds());
  EXPECT_EQ(theorem2.checks().size(), 1);
}

TEST(Theorem2, AGroupThatIsTooLargeIsNotRun) {
  Theorem2Options options;
  options.max_group_order = 20;
  const Theorem2 theorem2 = theorem2_of(test::sample_embedding("432"), options);
  EXPECT_EQ(theorem2.status, Status::not_run);
  EXPECT_THAT(theorem2.detail, HasSubstr("24"));
  EXPECT_FALSE(theorem2.holds());
}

}  // namespace
}  // namespace orbitutte::theorem2_test
