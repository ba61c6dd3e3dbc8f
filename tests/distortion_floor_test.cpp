// SPDX-License-Identifier: MIT
#include "orbitutte/distortion_floor.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "orbitutte/mesh/subdivision.h"
#include "orbitutte/verify/laid_out.h"
#include "sample_embeddings.h"

namespace orbitutte::distortion_floor_test {
namespace {

double area_of(const Points& V, const Triangles& F) {
  double sum = 0;
  for (int f = 0; f < F.rows(); ++f) {
    const Vector3 a = V.row(F(f, 0)), b = V.row(F(f, 1)), c = V.row(F(f, 2));
    sum += 0.5 * (b - a).cross(c - a).norm();
  }
  return sum;
}

TEST(Subdivision, KeepsVerticesTopologyAndArea) {
  for (const std::string signature : {"432", "*432", "2x"}) {
    const Mesh mesh = test::sample_mesh_for(parse_orbifold(signature));
    const Mesh fine = subdivided(mesh);
    EXPECT_EQ(fine.F.rows(), 4 * mesh.F.rows());
    EXPECT_EQ(fine.V.topRows(mesh.V.rows()), mesh.V);
    EXPECT_EQ(make_surface(fine).topology, make_surface(mesh).topology) << signature;
    EXPECT_NEAR(area_of(fine.V, fine.F), area_of(mesh.V, mesh.F), 1e-12 * area_of(mesh.V, mesh.F));
  }
}

TEST(Subdivision, TrianglesStandWhereTheirNumbersSay) {
  const Mesh mesh = test::sample_mesh_for(parse_orbifold("432"));
  const Mesh fine = subdivided(mesh);
  for (int f = 0; f < mesh.F.rows(); ++f) {
    for (int k = 0; k < 3; ++k) EXPECT_EQ(fine.F(4 * f + k, 0), mesh.F(f, k));
    for (int k = 0; k < 3; ++k) EXPECT_GE(fine.F(4 * f + 3, k), mesh.V.rows());
  }
}

class FloorOfFamily : public testing::TestWithParam<std::string> {};

// The coarse triangles tile the orbifold as the fine ones do, whatever seams run through them.
TEST_P(FloorOfFamily, SampledTrianglesTileTheOrbifold) {
  const Target target = parse_orbifold(GetParam());
  const Mesh mesh = test::sample_mesh_for(target);
  const Surface fine = make_surface(subdivided(subdivided(mesh)));
  const EmbedResult map = embed(fine, target, choose_cones(mesh, target));
  ASSERT_TRUE(map.certificate.bijective);
  const Embedding sampled = sampled_on(mesh.F, fine, map.embedding);
  double area = 0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    std::array<int, 3> source, expected;
    for (int k = 0; k < 3; ++k) source[k] = sampled.source_vertex[sampled.triangles(f, k)];
    for (int k = 0; k < 3; ++k) expected[k] = mesh.F(f, k);
    std::sort(source.begin(), source.end());
    std::sort(expected.begin(), expected.end());
    ASSERT_EQ(source, expected);
    const auto at = [&](int k) { return sampled.positions.row(sampled.triangles(f, k)).transpose(); };
    area += target.space.area(at(0), at(1), at(2));
  }
  EXPECT_NEAR(area, map.certificate.expected_area, 1e-9 * map.certificate.expected_area);
}

INSTANTIATE_TEST_SUITE_P(AllFamilies, FloorOfFamily,
                         testing::Values("532", "432", "225", "33", "*432", "*33", "3*2", "2*5", "3*", "1x",
                                         "3x", "442", "2222", "*442"));

// What the mesh's coarseness costs is less than what a map of the mesh costs, and vanishes with it.
TEST(DistortionFloor, LiesBelowTheMapAndVanishesOnFinerMeshes) {
  const Target target = parse_orbifold("432");
  double coarser = 1e9;
  for (const int level : {2, 3, 4}) {
    Mesh mesh = test::icosphere(level);
    mesh.V.col(2) *= 3;
    const Surface surface = make_surface(mesh);
    const std::vector<int> cones = choose_cones(surface, target);
    const auto floor = distortion_floor(surface, target, cones);
    ASSERT_TRUE(floor);
    EXPECT_EQ(floor->measured_faces, mesh.F.rows());
    EXPECT_LE(floor->angle.median, embed(surface, target, cones).distortion.angle.median * 1.01);
    EXPECT_LT(floor->angle.median - 1, 0.7 * (coarser - 1));
    coarser = floor->angle.median;
  }
}

// The file of weights is of the coarse mesh: it must not be asked for.
TEST(DistortionFloor, DoesNotDependOnTheWeights) {
  const Target target = parse_orbifold("432");
  const Surface surface = make_surface(test::perturbed(test::icosphere(2), 0.03, 7));
  const std::vector<int> cones = choose_cones(surface, target);
  EmbedOptions options;
  options.weights.kind = WeightKind::uniform;
  options.weights_file = "no such file";
  const auto floor = distortion_floor(surface, target, cones),
             other = distortion_floor(surface, target, cones, options);
  ASSERT_TRUE(floor && other);
  EXPECT_EQ(floor->angle.mean, other->angle.mean);
}

}  // namespace
}  // namespace orbitutte::distortion_floor_test
