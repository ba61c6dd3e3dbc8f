// SPDX-License-Identifier: MIT
// Intrinsic Delaunay triangulations: flips, the metric at cones, gluing across the cut, and the certificate.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <set>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/report/verification.h"
#include "orbitutte/solve/flipped_edges.h"
#include "orbitutte/verify/energy.h"
#include "orbitutte/verify/laid_out.h"
#include "orbitutte/weights/cone_weights.h"
#include "orbitutte/weights/delaunay_flips.h"
#include "sample_embeddings.h"
#include "solve_cases.h"

namespace orbitutte::intrinsic_test {
namespace {

using std::numbers::pi;
using test::vertex_count;

IntrinsicTriangulation unflipped(const Mesh& mesh) { return intrinsic_triangulation(test::unjudged(mesh)); }

IntrinsicTriangulation delaunay(const Mesh& mesh, const std::vector<int>& kept_faces = {}) {
  IntrinsicTriangulation result = unflipped(mesh);
  result.kept_faces = kept_faces;
  std::vector<int> all(result.connectivity.edges.size());
  std::iota(all.begin(), all.end(), 0);
  make_delaunay(result, all);
  return result;
}

EdgeWeights delaunay_weights(const Mesh& mesh) {
  return edge_weights(test::unjudged(mesh), {WeightKind::delaunay, 0.01});
}

/// Many obtuse angles, on spheres and disks.
std::vector<Mesh> obtuse_meshes() {
  std::vector<Mesh> result;
  for (const std::uint32_t seed : {1, 2, 3}) {
    result.push_back(test::perturbed(test::icosphere(2), 0.15, seed));
    result.push_back(test::perturbed(test::octasphere(3), 0.1, seed));
    result.push_back(test::perturbed(test::grid_disk(12, 9), 0.45, seed));
    result.push_back(test::perturbed(test::round_disk(7), 0.08, seed));
  }
  return result;
}

/// The sum of both sides' values, of every edge.
Eigen::VectorXd summed(const IntrinsicTriangulation& T) {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(T.connectivity.edges.size()));
  for (std::size_t h = 0; h < T.half_cotangent.size(); ++h)
    sum[T.connectivity.edge_of[h]] += T.half_cotangent[h];
  return sum;
}

double angle(const IntrinsicTriangulation& T, int h) {
  const double a = T.length[next_halfedge(h)], b = T.length[h], c = T.length[previous_halfedge(h)];
  return std::acos(std::clamp((b * b + c * c - a * a) / (2 * b * c), -1.0, 1.0));
}

std::vector<double> angle_sums(const IntrinsicTriangulation& T, int vertices) {
  std::vector<double> sums(vertices, 0.0);
  for (int h = 0; h < static_cast<int>(T.F.size()); ++h) sums[halfedge_origin(T.F, h)] += angle(T, h);
  return sums;
}

double area(const IntrinsicTriangulation& T) {
  double sum = 0;
  for (int f = 0; f < T.F.rows(); ++f)
    sum += 0.5 * T.length[3 * f] * T.length[3 * f + 2] * std::sin(angle(T, 3 * f));
  return sum;
}

void expect_sound(const IntrinsicTriangulation& T, const Mesh& mesh) {
  std::set<std::array<int, 2>> ends;
  for (const auto& [i, j] : T.connectivity.edges) {
    EXPECT_NE(i, j);
    EXPECT_TRUE(ends.insert({std::min(i, j), std::max(i, j)}).second) << i << ' ' << j << " twice";
  }
  for (int h = 0; h < static_cast<int>(T.F.size()); ++h) {
    const auto [i, j] = T.connectivity.edges[T.connectivity.edge_of[h]];
    EXPECT_EQ(std::minmax(i, j), std::minmax(halfedge_origin(T.F, h), halfedge_target(T.F, h)));
    const int g = T.connectivity.opposite[h];
    if (g < 0) continue;
    EXPECT_EQ(T.connectivity.opposite[g], h);
    EXPECT_EQ(T.connectivity.edge_of[g], T.connectivity.edge_of[h]);
    EXPECT_EQ(halfedge_origin(T.F, g), halfedge_target(T.F, h));
  }
  // What connects the faces anew finds the same surface.
  const Connectivity anew = connectivity_of(T.F, vertex_count(mesh)), before = test::edges_of(mesh);
  EXPECT_EQ(anew.edges.size(), before.edges.size());
  EXPECT_EQ(std::count(anew.opposite.begin(), anew.opposite.end(), -1),
            std::count(before.opposite.begin(), before.opposite.end(), -1));
}

// --- flips

TEST(IntrinsicDelaunay, EveryEdgeIsDelaunayOrBlocked) {
  for (const Mesh& mesh : obtuse_meshes()) {
    const IntrinsicTriangulation T = delaunay(mesh);
    EXPECT_GT(T.flips.size(), 5u);
    const Eigen::VectorXd before = summed(unflipped(mesh)), after = summed(T);
    int negative = 0;
    for (int e = 0; e < after.size(); ++e) {
      const int h =
          static_cast<int>(std::find(T.connectivity.edge_of.begin(), T.connectivity.edge_of.end(), e) -
                           T.connectivity.edge_of.begin());
      negative += T.connectivity.opposite[h] >= 0 && after[e] < -1e-8;
    }
    EXPECT_LT(negative, 3);
    EXPECT_GT((before.array() < 0).count(), 5);
  }
}

TEST(IntrinsicDelaunay, StaysASimplicialSurfaceOfTheSameTopology) {
  for (const Mesh& mesh : obtuse_meshes()) expect_sound(delaunay(mesh), mesh);
}

TEST(IntrinsicDelaunay, KeepsAreaAndAngleSums) {
  for (const Mesh& mesh : obtuse_meshes()) {
    const IntrinsicTriangulation before = unflipped(mesh), after = delaunay(mesh);
    EXPECT_NEAR(area(after), area(before), 1e-10 * area(before));
    const auto old_sums = angle_sums(before, vertex_count(mesh)),
               sums = angle_sums(after, vertex_count(mesh));
    for (std::size_t v = 0; v < sums.size(); ++v) EXPECT_NEAR(sums[v], old_sums[v], 1e-8);
  }
}

// S. Rippa, "Minimal roughness property of the Delaunay triangulation", CAGD 7 (1990).
TEST(IntrinsicDelaunay, NoFunctionHasMoreDirichletEnergyThanBefore) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto energy = [](const IntrinsicTriangulation& T, const Eigen::VectorXd& u) {
    const Eigen::VectorXd w = summed(T);
    double sum = 0;
    for (int e = 0; e < w.size(); ++e) {
      const auto [i, j] = T.connectivity.edges[e];
      sum += w[e] * (u[i] - u[j]) * (u[i] - u[j]);
    }
    return sum;
  };
  for (const Mesh& mesh : obtuse_meshes()) {
    const IntrinsicTriangulation before = unflipped(mesh), after = delaunay(mesh);
    for (int k = 0; k < 10; ++k) {
      const Eigen::VectorXd u = Eigen::VectorXd::NullaryExpr(mesh.V.rows(), [&] { return uniform(random); });
      EXPECT_LT(energy(after, u), energy(before, u));
    }
  }
}

// Linear functions of a plane mesh are harmonic in any triangulation of it.
TEST(IntrinsicDelaunay, CotangentsReproduceLinearFunctionsOfThePlane) {
  Mesh mesh = test::perturbed(test::grid_disk(12, 9), 0.25, 4);
  mesh.V.col(2).setZero();
  const IntrinsicTriangulation T = delaunay(mesh);
  const Eigen::VectorXd w = summed(T);
  Points pull = Points::Zero(mesh.V.rows(), 3);
  std::vector<char> outer(mesh.V.rows(), 0);
  for (int e = 0; e < w.size(); ++e) {
    const auto [i, j] = T.connectivity.edges[e];
    pull.row(i) += w[e] * (mesh.V.row(j) - mesh.V.row(i));
    pull.row(j) += w[e] * (mesh.V.row(i) - mesh.V.row(j));
  }
  for (int h = 0; h < static_cast<int>(T.F.size()); ++h)
    if (T.connectivity.opposite[h] < 0) outer[halfedge_origin(T.F, h)] = outer[halfedge_target(T.F, h)] = 1;
  for (Eigen::Index v = 0; v < pull.rows(); ++v)
    if (!outer[v]) EXPECT_LT(pull.row(v).norm(), 1e-5) << v;
}

TEST(IntrinsicDelaunay, LeavesNoVertexOfTheBoundaryWithASingleFace) {
  for (const std::uint32_t seed : {1, 2, 3, 4, 5}) {
    const Mesh mesh = test::perturbed(test::grid_disk(9, 9), 0.45, seed);
    const auto ears = [&](const Triangles& F) {
      std::vector<int> faces(vertex_count(mesh), 0);
      for (const int v : F.reshaped()) ++faces[v];
      return std::count(faces.begin(), faces.end(), 1);
    };
    EXPECT_LE(ears(delaunay(mesh).F), ears(mesh.F));
  }
}

TEST(IntrinsicDelaunay, FacesMayBeTurnedOver) {
  for (const Mesh& mesh : obtuse_meshes()) {
    Mesh turned = mesh;
    for (int f = 0; f < turned.F.rows(); f += 3) std::swap(turned.F(f, 1), turned.F(f, 2));
    const IntrinsicTriangulation one = delaunay(mesh), other = delaunay(turned);
    ASSERT_EQ(one.connectivity.edges.size(), other.connectivity.edges.size());
    std::set<std::array<int, 2>> ends, other_ends;
    for (const auto& [i, j] : one.connectivity.edges) ends.insert({std::min(i, j), std::max(i, j)});
    for (const auto& [i, j] : other.connectivity.edges) other_ends.insert({std::min(i, j), std::max(i, j)});
    EXPECT_EQ(ends, other_ends);
  }
}

TEST(IntrinsicDelaunay, KeptFacesStayFaces) {
  const Mesh mesh = test::perturbed(test::icosphere(2), 0.15, 1);
  const std::vector<int> kept = {3, 100, 200};
  const IntrinsicTriangulation T = delaunay(mesh, kept);
  EXPECT_GT(T.flips.size(), 5u);
  for (const int f : kept) EXPECT_EQ(T.F.row(f), mesh.F.row(f));
  EXPECT_THROW(edge_weights(test::unjudged(mesh), {WeightKind::delaunay}, {{test::face_count(mesh)}}),
               MeshError);
}

// --- mollification

TEST(MollifiedLengths, AreThoseInSpaceWhereNoTriangleIsThin) {
  const Mesh mesh = test::icosphere(2);
  const Connectivity connectivity = test::edges_of(mesh);
  const std::vector<double> length = mollified_lengths(test::unjudged(mesh));
  const auto in_space = [&](int e) {
    const auto [i, j] = connectivity.edges[e];
    return (mesh.V.row(i) - mesh.V.row(j)).norm();
  };
  for (std::size_t e = 0; e < length.size(); ++e)
    EXPECT_NEAR(length[e] / length[0], in_space(static_cast<int>(e)) / in_space(0), 1e-14);
  EXPECT_NEAR(std::accumulate(length.begin(), length.end(), 0.0) / static_cast<double>(length.size()), 1,
              1e-14);
}

TEST(MollifiedLengths, MakeEveryTriangleInequalityStrict) {
  const Mesh collinear =
      test::mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 3}, {1, 2, 3}, {0, 2, 1}});
  const Mesh coincident = test::mesh({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}, {1, 2, 3}});
  Mesh point = test::octahedron();
  point.V.setConstant(3);
  for (const Mesh& mesh : {collinear, coincident, point}) {
    const IntrinsicTriangulation T = unflipped(mesh);
    for (int h = 0; h < static_cast<int>(T.F.size()); ++h)
      EXPECT_GT(T.length[next_halfedge(h)] + T.length[previous_halfedge(h)] - T.length[h], 0.9e-8);
  }
}

// --- weights

TEST(DelaunayWeights, ArePositiveAndFiniteOnSliversAndFacesWithoutArea) {
  const Mesh collinear =
      test::mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 3}, {1, 2, 3}, {0, 2, 1}});
  Mesh point = test::octahedron(), sliver = test::icosphere(1), huge = test::icosphere(1), tiny = huge;
  point.V.setConstant(3);
  sliver.V.row(0) = 0.5 * (sliver.V.row(12) + sliver.V.row(13));
  huge.V *= 1e200;
  tiny.V *= 1e-200;
  for (const Mesh& mesh : {collinear, point, sliver, huge, tiny}) {
    for (const WeightKind kind : {WeightKind::delaunay, WeightKind::mean_value}) {
      const EdgeWeights weights = edge_weights(test::unjudged(mesh), {kind, 0.01});
      EXPECT_EQ(weights.kind, kind);
      EXPECT_TRUE(weights.w.allFinite());
      EXPECT_GT(weights.w.minCoeff(), 0);
    }
  }
}

TEST(DelaunayWeights, OfAnAcuteMeshAreTheCotangents) {
  const Mesh mesh = test::icosphere(3);
  const EdgeWeights plain = edge_weights(test::unjudged(mesh), {}), weights = delaunay_weights(mesh);
  ASSERT_EQ(plain.clamped_edges, 0);
  EXPECT_TRUE(weights.triangulation->flips.empty());
  EXPECT_LT((weights.w - plain.w).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(DelaunayWeights, OfARightAngledGridAreNearlyZeroOnItsDiagonals) {
  const EdgeWeights weights = delaunay_weights(test::grid_disk(7, 5));
  EXPECT_TRUE(weights.triangulation->flips.empty());
  EXPECT_EQ(weights.clamped_edges, 0);
  EXPECT_EQ((weights.w.array() == 1e-6).count(), 35);
  EXPECT_EQ((weights.w.array() > 0.49).count(), weights.w.size() - 35);
}

TEST(DelaunayWeights, DoNotChangeByABitWithTheScale) {
  for (const Mesh& mesh : obtuse_meshes()) {
    for (const WeightKind kind : {WeightKind::delaunay, WeightKind::mean_value}) {
      Mesh scaled = mesh;
      scaled.V *= 0x1p40;
      const WeightOptions options = {kind, 0.01};
      EXPECT_EQ(edge_weights(test::unjudged(scaled), options).w,
                edge_weights(test::unjudged(mesh), options).w);
    }
  }
}

TEST(MeanValueWeights, OfRegularTrianglesAreTheCotangents) {
  const Mesh mesh = test::icosahedron();
  const EdgeWeights weights = edge_weights(test::unjudged(mesh), {WeightKind::mean_value, 0.01});
  for (const double w : weights.w) EXPECT_NEAR(w, 1 / std::sqrt(3), 1e-13);
  EXPECT_FALSE(weights.triangulation);
}

TEST(MeanValueWeights, AreTheMeanOfThoseThatReproduceLinearFunctions) {
  const Mesh mesh = test::perturbed(test::grid_disk(8, 6), 0.3, 2);
  Mesh flat = mesh;
  flat.V.col(2).setZero();
  const Connectivity connectivity = test::edges_of(flat);
  const int n = vertex_count(flat);
  const auto at = [&](int v) -> Vector3 { return flat.V.row(v); };
  const auto half_tangent = [&](int v, int a, int b) {
    const Vector3 p = (at(a) - at(v)).normalized(), q = (at(b) - at(v)).normalized();
    return std::tan(std::acos(std::clamp(p.dot(q), -1.0, 1.0)) / 2);
  };
  Eigen::MatrixXd m = Eigen::MatrixXd::Zero(n, n);
  std::vector<char> outer(n, 0);
  for (int h = 0; h < static_cast<int>(flat.F.size()); ++h) {
    const int i = halfedge_origin(flat.F, h), j = halfedge_target(flat.F, h),
              k = halfedge_origin(flat.F, previous_halfedge(h));
    m(i, j) += half_tangent(i, j, k) / (at(i) - at(j)).norm();
    m(i, k) += half_tangent(i, j, k) / (at(i) - at(k)).norm();
    if (connectivity.opposite[h] < 0) outer[i] = outer[j] = 1;
  }
  std::vector<double> scale(n, 0.0);
  for (int v = 0; v < n; ++v) {
    Vector3 pull = Vector3::Zero();
    int degree = 0;
    for (int u = 0; u < n; ++u) {
      if (m(v, u) == 0) continue;
      pull += m(v, u) * (at(u) - at(v));
      scale[v] += (at(u) - at(v)).norm();
      ++degree;
    }
    scale[v] /= 2 * degree;
    if (!outer[v]) EXPECT_LT(pull.norm(), 1e-12);
  }
  const EdgeWeights weights = edge_weights(test::unjudged(flat), {WeightKind::mean_value, 0.01});
  for (std::size_t e = 0; e < connectivity.edges.size(); ++e) {
    const auto [i, j] = connectivity.edges[e];
    EXPECT_NEAR(weights.w[static_cast<Eigen::Index>(e)], (scale[i] * m(i, j) + scale[j] * m(j, i)) / 2, 1e-7);
  }
}

// --- cones

double angle_sum(const IntrinsicTriangulation& T, int v) {
  double sum = 0;
  for (int h = 0; h < static_cast<int>(T.F.size()); ++h)
    if (halfedge_origin(T.F, h) == v) sum += angle(T, h);
  return sum;
}

TEST(Cones, AnglesAtThemAreThoseOfTheImage) {
  const Mesh mesh = test::icosphere(2);
  for (const double expected : {pi, 2 * pi / 3, pi / 2, 2 * pi / 5, 2 * pi / 12}) {
    const std::vector<ConeAngle> cones = {{20, expected}, {100, pi}};
    const EdgeWeights before = delaunay_weights(mesh), weights = sharpened_at_cones(before, cones);
    const IntrinsicTriangulation T = flattened_at_cones(*before.triangulation, cones);
    EXPECT_NEAR(angle_sum(T, 20), expected, 1e-10);
    EXPECT_NEAR(angle_sum(T, 100), pi, 1e-10);
    EXPECT_EQ(weights.w, intrinsic_weights(T, before.clamp).w);
    EXPECT_GT(weights.w.minCoeff(), 0);
    EXPECT_LE(weights.clamped_edges, expected < 1 ? 1 : 0);  // a sharp cone asks for less than three edges
    expect_sound(*weights.triangulation, mesh);
  }
}

TEST(Cones, ThatKeepTheirAnglesChangeNothing) {
  const Mesh mesh = test::perturbed(test::icosphere(2), 0.1, 3);
  const EdgeWeights before = delaunay_weights(mesh);
  const EdgeWeights after = sharpened_at_cones(before, {{20, angle_sum(*before.triangulation, 20)}});
  EXPECT_LT((after.w - before.w).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Cones, AreNothingToWeightsOfTheMeshItself) {
  const Mesh mesh = test::icosphere(1);
  for (const WeightKind kind : {WeightKind::cotan, WeightKind::mean_value, WeightKind::uniform}) {
    const EdgeWeights before = edge_weights(test::unjudged(mesh), {kind, 0.01});
    EXPECT_EQ(sharpened_at_cones(before, {{3, 1.0}}).w, before.w);
  }
}

TEST(Cones, TwoOnOneFaceLeaveItAsItIs) {
  const Mesh mesh = test::icosphere(1);
  const int a = mesh.F(5, 0), b = mesh.F(5, 1), c = mesh.F(5, 2);
  const EdgeWeights weights = sharpened_at_cones(delaunay_weights(mesh), {{a, 1.0}, {b, 1.5}, {c, pi}});
  EXPECT_TRUE(weights.w.allFinite());
  EXPECT_GT(weights.w.minCoeff(), 0);
}

/// A long bar, whose Delaunay triangulation joins vertices that the bar does not.
Mesh bar() {
  Mesh mesh;
  mesh.V.resize(8, 3);
  for (int v = 0; v < 8; ++v) mesh.V.row(v) << 10 * (v / 4), v / 2 % 2, v % 2;
  mesh.F.resize(12, 3);
  mesh.F << 0, 1, 3, 0, 3, 2, 4, 6, 7, 4, 7, 5, 0, 4, 5, 0, 5, 1, 2, 3, 7, 2, 7, 6, 0, 2, 6, 0, 6, 4, 1, 5, 7,
      1, 7, 3;
  return mesh;
}

bool joins(const Connectivity& connectivity, int v, int w) {
  return std::any_of(connectivity.edges.begin(), connectivity.edges.end(), [&](const auto& edge) {
    return edge == std::array{v, w} || edge == std::array{w, v};
  });
}

// Two flat pyramids over one triangle: its edges are not Delaunay, and a flip joins the apices.
Mesh flat_bipyramid() {
  Mesh mesh{Points(5, 3), Triangles(6, 3)};
  mesh.V << 0, 0, 0.2, 0, 0, -0.2, 1, 0, 0, -0.5, 0.9, 0, -0.5, -0.9, 0;
  mesh.F << 0, 2, 3, 0, 3, 4, 0, 4, 2, 1, 3, 2, 1, 4, 3, 1, 2, 4;
  return mesh;
}

TEST(Cones, AtOppositePointsAreJoinedByNoEdgeOfTheTriangulation) {
  int joined_by_flips = 0;
  for (const Mesh& mesh : {bar(), flat_bipyramid()}) {
    const Connectivity connectivity = test::edges_of(mesh);
    const EdgeWeights weights = delaunay_weights(mesh);
    const int n = static_cast<int>(mesh.V.rows());
    for (int pair = 0; pair < n * n; ++pair) {
      const int v = pair / n, w = pair % n;
      if (v >= w) continue;
      if (joins(connectivity, v, w)) continue;
      joined_by_flips += joins(weights.triangulation->connectivity, v, w);
      const std::vector<std::array<int, 2>> apart = {{v, w}};
      const EdgeWeights kept = kept_apart(weights, test::unjudged(mesh), {}, {{}, apart});
      const EdgeWeights sharpened = sharpened_at_cones(kept, {{v, pi}, {w, pi}}, apart);
      EXPECT_FALSE(joins(kept.triangulation->connectivity, v, w)) << v << " " << w;
      EXPECT_FALSE(joins(sharpened.triangulation->connectivity, v, w)) << v << " " << w;
      EXPECT_GT(sharpened.w.minCoeff(), 0);
    }
  }
  EXPECT_GT(joined_by_flips, 0);
}

TEST(Cones, AtOppositePointsThatNoEdgeJoinsAreEmbeddedAndTheOthersAreNot) {
  const Mesh mesh = bar();
  const Connectivity connectivity = test::edges_of(mesh);
  for (int v = 0; v < 8; ++v) {
    for (int w = v + 1; w < 8; ++w) {
      for (const WeightKind kind : {WeightKind::delaunay, WeightKind::cotan}) {
        EmbedOptions options;
        options.weights.kind = kind;
        if (joins(connectivity, v, w)) {
          EXPECT_THROW(embed(mesh, parse_orbifold("33"), {v, w}, options), MeshError) << v << " " << w;
        } else {
          EXPECT_TRUE(embed(mesh, parse_orbifold("33"), {v, w}, options).certificate.bijective)
              << v << " " << w;
        }
      }
    }
  }
}

// --- gluing

std::vector<ConeAngle> cones_of(const Target& orbifold, const std::vector<int>& marks) {
  const std::vector<double> angles = metric_angles(orbifold.marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < marks.size(); ++k) cones.push_back({marks[k], angles[k]});
  return cones;
}

TEST(Cones, HaveTheAnglesOfTheOrbifoldButThoseOfAFreeAxisTwice) {
  const auto angles = [](const char* signature) { return metric_angles(parse_orbifold(signature).marks); };
  EXPECT_EQ(angles("532"), (std::vector{2 * pi / 5, 2 * pi / 3, pi}));
  EXPECT_EQ(angles("*222"), (std::vector{pi / 2, pi / 2, pi / 2}));
  EXPECT_EQ(angles("2*2"), (std::vector{pi, pi / 2}));
  EXPECT_EQ(angles("5*"), (std::vector{2 * pi / 5}));
  EXPECT_EQ(angles("33"), (std::vector{4 * pi / 3, 4 * pi / 3}));
  EXPECT_EQ(angles("*33"), (std::vector{2 * pi / 3, 2 * pi / 3}));
}

/// A mesh with many flips, cut and glued.
std::unique_ptr<test::SolveCase> intrinsic_case(const std::string& signature,
                                                const CutOptions& options = {}) {
  auto result = test::solve_case(signature, options);
  test::SolveCase& c = *result;
  const bool sphere = c.orbifold.topology == Topology::sphere;
  c.mesh = test::perturbed(sphere ? test::icosphere(2) : test::round_disk(7), sphere ? 0.13 : 0.07, 7);
  c.marks = choose_cones(c.mesh, c.orbifold);
  c.weights = sharpened_at_cones(delaunay_weights(c.mesh), cones_of(c.orbifold, c.marks));
  c.cut = cut_to_disk(test::unjudged(c.mesh), c.marks, c.orbifold.inner_marks, options);
  c.tile = basic_tile(c.orbifold, c.cut.arrangement);
  c.boundary = glue(c.cut, c.tile, c.orbifold);
  c.glued = flipped_edges(test::unjudged(c.mesh), *c.weights.triangulation, c.cut, c.boundary);
  return result;
}

class FlippedEdges : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Intrinsic, FlippedEdges, testing::ValuesIn(test::signatures()),
                         [](const auto& info) {
                           std::string name = info.param;
                           if (const std::size_t at = name.find('*'); at != std::string::npos)
                             name.replace(at, 1, "star");
                           return name;
                         });

TEST_P(FlippedEdges, WithoutFlipsAreTheGluedEdges) {
  const auto c = test::solve_case(GetParam());
  const Surface surface = test::unjudged(c->mesh);
  const GluedEdges expected = glued_edges(c->cut, c->connectivity, c->boundary),
                   glued = flipped_edges(surface, intrinsic_triangulation(surface), c->cut, c->boundary);
  ASSERT_EQ(glued.edges.size(), expected.edges.size());
  for (std::size_t e = 0; e < glued.edges.size(); ++e) {
    EXPECT_EQ(glued.edges[e].i, expected.edges[e].i);
    EXPECT_EQ(glued.edges[e].j, expected.edges[e].j);
    EXPECT_LT(glued.transforms[glued.edges[e].t].difference(expected.transforms[expected.edges[e].t]), 1e-12);
  }
}

// Going around a face leads back, seen from any vertex of it that is no cone: there, stabilizers differ.
TEST_P(FlippedEdges, GoAroundEveryFaceToTheIdentity) {
  const auto c = intrinsic_case(GetParam());
  const IntrinsicTriangulation& T = *c->weights.triangulation;
  EXPECT_GT(T.flips.size(), 3u);
  const auto along = [&](int h) {
    const auto [i, j, t] = c->glued.edges[T.connectivity.edge_of[h]];
    return i == halfedge_origin(T.F, h) ? c->glued.transforms[t] : c->glued.transforms[t].inverse();
  };
  for (int f = 0; f < T.F.rows(); ++f) {
    const bool at_cone = std::any_of(T.F.row(f).begin(), T.F.row(f).end(),
                                     [&](int v) { return c->boundary.basis(v).cols() == 0; });
    if (at_cone) continue;
    EXPECT_LT((along(3 * f) * along(3 * f + 1) * along(3 * f + 2)).difference({}), 1e-12);
  }
}

TEST_P(FlippedEdges, GradientAgreesWithDifferencesOfTheEnergy) {
  const auto c = intrinsic_case(GetParam());
  const DirichletEnergy energy(c->glued, c->weights, c->boundary);
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const Points start = initial_embedding(test::unjudged(c->mesh), c->cut, c->tile, c->boundary, laplacian);
  const Points x = (start + 0.02 * test::random_feasible(*c, 2)).rowwise().normalized(),
               direction = test::random_feasible(*c, 3);
  const double h = 1e-5;
  const auto energy_at = [&](double t) {
    return energy.evaluate((x + t * direction).rowwise().normalized()).energy;
  };
  const double slope = energy.evaluate(x).gradient.cwiseProduct(direction).sum();
  EXPECT_NEAR(slope, (energy_at(h) - energy_at(-h)) / (2 * h), 1e-7 * (1 + std::abs(slope)));
}

TEST_P(FlippedEdges, PreconditionerInvertsTwiceTheirLaplacian) {
  const auto c = intrinsic_case(GetParam());
  const LaplacianSolver laplacian(c->cut, c->glued, c->weights, c->boundary);
  const Points x = test::random_feasible(*c, 6);
  Points Lx = Points::Zero(x.rows(), 3);
  for (std::size_t e = 0; e < c->glued.edges.size(); ++e) {
    const auto [i, j, t] = c->glued.edges[e];
    const Isometry& g = c->glued.transforms[t];
    const Vector3 difference = Vector3(x.row(i)) - g * Vector3(x.row(j));
    Lx.row(i) += 2 * c->weights.w[static_cast<Eigen::Index>(e)] * difference;
    Lx.row(j) -= 2 * c->weights.w[static_cast<Eigen::Index>(e)] * (g.inverse() * difference);
  }
  for (Eigen::Index v = 0; v < x.rows(); ++v) {
    const Room& room = c->boundary.basis(static_cast<int>(v));
    Lx.row(v) = room * (room.transpose() * Vector3(Lx.row(v)));
  }
  // The factor is in single precision.
  EXPECT_LT((laplacian.precondition(Lx) - x).cwiseAbs().maxCoeff(), 1e-5);
}

// --- embeddings, certificate

EmbedResult embedded(const Mesh& mesh, const std::string& signature, const std::vector<int>& marks,
                     const EmbedOptions& options) {
  return embed(mesh, parse_orbifold(signature), marks, options);
}

EmbedOptions with(WeightKind kind) {
  EmbedOptions options;
  options.threads = 1;
  options.weights.kind = kind;
  return options;
}

class IntrinsicEmbedding : public testing::TestWithParam<std::string> {};
INSTANTIATE_TEST_SUITE_P(Intrinsic, IntrinsicEmbedding, testing::ValuesIn(test::signatures()),
                         [](const auto& info) {
                           std::string name = info.param;
                           if (const std::size_t at = name.find('*'); at != std::string::npos)
                             name.replace(at, 1, "star");
                           return name;
                         });

TEST_P(IntrinsicEmbedding, IsCertifiedAndHasTheEnergyOfItsTriangulation) {
  const auto c = intrinsic_case(GetParam());
  for (const WeightKind kind : {WeightKind::delaunay, WeightKind::mean_value}) {
    const EmbedOptions options = with(kind);
    const EmbedResult result = embedded(c->mesh, GetParam(), c->marks, options);
    EXPECT_EQ(result.minimum.termination, Termination::converged);
    EXPECT_TRUE(result.certificate.bijective);
    EXPECT_FALSE(result.intrinsic_certificate.has_value());
    const Surface surface = make_surface(c->mesh);
    Report report;
    report.weights = options.weights;
    if (result.weights.triangulation) {
      report.kept_faces = result.weights.triangulation->kept_faces;
      EXPECT_TRUE(certify_intrinsic(surface, result.embedding, *result.weights.triangulation).bijective);
    }
    const EdgeWeights weights = weights_of(surface, result.embedding, report);
    EXPECT_NEAR(dirichlet_energy(surface, weights, result.embedding), result.minimum.energy,
                1e-12 * result.minimum.energy);
  }
}

TEST_P(IntrinsicEmbedding, DoesNotKnowWhereTheCutRuns) {
  const auto c = intrinsic_case(GetParam());
  const EmbedResult one = embedded(c->mesh, GetParam(), c->marks, with(WeightKind::delaunay));
  const Eigen::VectorXd lengths = test::edge_lengths(c->mesh, one.embedding);
  for (const std::uint64_t seed : {1, 2, 3}) {
    EmbedOptions options = with(WeightKind::delaunay);
    options.cut.seed = seed;
    const EmbedResult other = embedded(c->mesh, GetParam(), c->marks, options);
    EXPECT_NEAR(other.minimum.energy, one.minimum.energy, 1e-12 * one.minimum.energy);
    EXPECT_LT((test::edge_lengths(c->mesh, other.embedding) - lengths).cwiseAbs().maxCoeff(), 1e-8);
  }
}

TEST_P(IntrinsicEmbedding, PlantedFaultsAreSeen) {
  const auto c = intrinsic_case(GetParam());
  const EmbedResult result = embedded(c->mesh, GetParam(), c->marks, with(WeightKind::delaunay));
  const IntrinsicTriangulation& T = *result.weights.triangulation;
  const auto accepted = [&](const Embedding& embedding, const IntrinsicTriangulation& triangulation) {
    return certify_intrinsic(test::unjudged(c->mesh), embedding, triangulation).bijective;
  };
  ASSERT_TRUE(accepted(result.embedding, T));
  IntrinsicTriangulation fewer_flips = T;
  fewer_flips.flips.pop_back();
  EXPECT_FALSE(accepted(result.embedding, fewer_flips));

  Embedding mirrored = result.embedding;
  mirrored.positions.col(2) *= -1;
  for (Seam& seam : mirrored.seams) {
    const Isometry mirror = Space::sphere().reflection(Vector3::UnitZ());
    seam.transform = mirror * seam.transform * mirror;
  }
  EXPECT_FALSE(accepted(mirrored, T));

  // A vertex inside moves onto the far side of an edge of the triangulation.
  std::vector<char> on_seam(c->mesh.V.rows(), 0);
  for (const Seam& seam : result.embedding.seams)
    for (const int v : seam.left) on_seam[result.embedding.source_vertex[v]] = 1;
  int f = 0;
  while (on_seam[T.F(f, 0)] || on_seam[T.F(f, 1)] || on_seam[T.F(f, 2)]) ++f;
  const Embedding layout = laid_out(test::unjudged(c->mesh), result.embedding, T);
  Embedding moved = result.embedding;
  const Vector3 a = layout.positions.row(3 * f), b = layout.positions.row(3 * f + 1),
                d = layout.positions.row(3 * f + 2);
  const Vector3 normal = b.cross(d).normalized();
  // In the frame of the face; the face may have been taken into another one than the tile's.
  const Vector3 there = (a - 2 * normal.dot(a) * normal).normalized();
  if ((Vector3(moved.positions.row(T.F(f, 0))) - a).norm() > 1e-12) return;
  moved.positions.row(T.F(f, 0)) = there;
  EXPECT_FALSE(accepted(moved, T));
}

TEST(IntrinsicEmbedding, DoesNotDependOnScaleRotationOrThreads) {
  const auto c = intrinsic_case("432");
  const EmbedResult one = embedded(c->mesh, "432", c->marks, with(WeightKind::delaunay));
  EmbedOptions threads = with(WeightKind::delaunay);
  threads.threads = 2;
  EXPECT_EQ(embedded(c->mesh, "432", c->marks, threads).embedding.positions, one.embedding.positions);
  Mesh moved = c->mesh;
  const Matrix3 turn = Eigen::AngleAxisd(1.1, Vector3(1, 2, 3).normalized()).toRotationMatrix();
  moved.V = (37 * moved.V * turn).eval();
  const EmbedResult other = embedded(moved, "432", c->marks, with(WeightKind::delaunay));
  EXPECT_NEAR(other.minimum.energy, one.minimum.energy, 1e-10 * one.minimum.energy);
  EXPECT_LT((test::edge_lengths(moved, other.embedding) - test::edge_lengths(c->mesh, one.embedding))
                .cwiseAbs()
                .maxCoeff(),
            1e-7);
}

TEST(IntrinsicEmbedding, SolverForManyGivesWhatSeparateEmbeddingsGive) {
  const auto c = intrinsic_case("432");
  EmbeddingSolver solver(c->mesh, with(WeightKind::delaunay));
  for (const std::string signature : {"432", "532", "432", "222"})
    EXPECT_EQ(solver.embed(parse_orbifold(signature), c->marks).embedding.positions,
              embedded(c->mesh, signature, c->marks, with(WeightKind::delaunay)).embedding.positions)
        << signature;
}

// The point of it all: with the clamp the mean angle distortion stays, or grows; here it falls to 1.
TEST(IntrinsicEmbedding, AngleDistortionFallsUnderRefinement) {
  Mesh mesh = test::perturbed(test::icosphere(2), 0.1, 5);
  const std::vector<int> marks = {0, 40, 101};
  double before = 10;
  for (int level = 0; level < 3; ++level) {
    const double delaunay = embedded(mesh, "432", marks, with(WeightKind::delaunay)).distortion.angle.mean,
                 cotan = embedded(mesh, "432", marks, with(WeightKind::cotan)).distortion.angle.mean;
    EXPECT_LT(delaunay, cotan);
    EXPECT_LT(delaunay - 1, 0.75 * (before - 1));
    before = delaunay;
    mesh = subdivided(mesh);
  }
}

// Along the axis of NN and *NN nothing but the error of the elements holds the map.
TEST(IntrinsicEmbedding, DoesNotSlideToOneEndOfAFreeAxis) {
  for (const std::string signature : {"22", "33", "55", "12,12", "*22", "*33", "*55", "*12,12"}) {
    const Target orbifold = parse_orbifold(signature);
    const Mesh mesh = orbifold.topology == Topology::sphere ? test::perturbed(test::icosphere(4), 0.01, 3)
                                                            : test::round_disk(24);
    const std::vector<int> marks = choose_cones(mesh, orbifold);
    const EmbedResult plain = embedded(mesh, signature, marks, with(WeightKind::cotan)),
                      result = embedded(mesh, signature, marks, with(WeightKind::delaunay));
    EXPECT_TRUE(result.certificate.bijective) << signature;
    EXPECT_LT(result.certificate.max_edge_length, 1.5) << signature;  // at the far end: above 2
    EXPECT_LT(result.distortion.angle.mean, plain.distortion.angle.mean + 0.002) << signature;
    EXPECT_GT(result.minimum.energy, 8 * pi / orbifold.group_order) << signature;
  }
}

TEST(IntrinsicEmbedding, FacesWithoutAreaSurvive) {
  for (const char* signature : {"532", "22", "*432", "2*3", "3*"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    for (const int face : {0, 20, 40, 80}) {
      Mesh mesh = sample.mesh;
      mesh.V.row(mesh.F(face, 0)) = (mesh.V.row(mesh.F(face, 1)) + mesh.V.row(mesh.F(face, 2))).eval() / 2;
      for (const WeightKind kind : {WeightKind::delaunay, WeightKind::mean_value})
        EXPECT_TRUE(embedded(mesh, signature, sample.marks, with(kind)).certificate.bijective)
            << signature << ' ' << face << ' ' << name_of(kind);
    }
  }
}

}  // namespace
}  // namespace orbitutte::intrinsic_test
