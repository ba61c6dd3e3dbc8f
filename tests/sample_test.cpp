// SPDX-License-Identifier: MIT
#include "orbitutte/samples/sample.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/mesh/connectivity.h"

namespace orbitutte::sample_test {
namespace {

constexpr double kDegree = std::numbers::pi / 180;

Vector3 normal(const Mesh& mesh, int f) {
  const Vector3 u = mesh.V.row(mesh.F(f, 1)) - mesh.V.row(mesh.F(f, 0));
  const Vector3 v = mesh.V.row(mesh.F(f, 2)) - mesh.V.row(mesh.F(f, 0));
  return u.cross(v).normalized();
}

// The largest angle between the normals of two faces at an edge.
double sharpest_edge(const Mesh& mesh) {
  const Connectivity connectivity = connectivity_of(mesh.F, static_cast<int>(mesh.V.rows()));
  double least_cosine = 1;
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h) {
    const int g = connectivity.opposite[h];
    if (g > h) least_cosine = std::min(least_cosine, normal(mesh, h / 3).dot(normal(mesh, g / 3)));
  }
  return std::acos(std::clamp(least_cosine, -1.0, 1.0));
}

double enclosed_volume(const Mesh& mesh) {
  double sum = 0;
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
    sum += a.dot(b.cross(c)) / 6;
  }
  return sum;
}

class SampleMeshes : public testing::TestWithParam<SampleOptions> {
 protected:
  bool is_figure() const { return GetParam().shape == SampleShape::figure; }
};

TEST_P(SampleMeshes, IsASphereOrADiskWithoutDefects) {
  const Inspection result = inspect(sample_mesh(GetParam()));
  EXPECT_TRUE(result.defects.empty());
  EXPECT_EQ(result.topology, is_figure() ? Topology::sphere : Topology::disk);
  EXPECT_EQ(result.unreferenced_vertices, 0);
}

TEST_P(SampleMeshes, HasEvenTriangles) {
  const Inspection result = inspect(sample_mesh(GetParam()));
  EXPECT_GT(result.min_angle, 16 * kDegree);
  EXPECT_LT(result.max_angle, 125 * kDegree);
  EXPECT_LT(result.max_edge_length, 7 * result.min_edge_length);
  EXPECT_LE(result.negative_cotangent_edges, 1 + 0.001 * result.edges);
}

TEST_P(SampleMeshes, HasNearlyAsManyFacesAsAskedFor) {
  const int asked = GetParam().faces, faces = static_cast<int>(sample_mesh(GetParam()).F.rows());
  if (asked > 10'000) {
    EXPECT_NEAR(faces, asked, 0.0005 * asked);
  } else if (is_figure()) {
    EXPECT_EQ(faces, std::max(124, asked + asked % 2));
  } else {
    EXPECT_EQ(faces, asked);
  }
}

TEST_P(SampleMeshes, IsTheSameEveryTime) {
  const Mesh first = sample_mesh(GetParam()), second = sample_mesh(GetParam());
  EXPECT_EQ(first.V, second.V);
  EXPECT_EQ(first.F, second.F);
}

TEST_P(SampleMeshes, HasConesFarFromEachOther) {
  const Mesh mesh = sample_mesh(GetParam());
  const std::vector<int> cones = sample_cones(GetParam().shape, mesh);
  ASSERT_EQ(cones.size(), is_figure() ? 3u : 4u);
  for (std::size_t i = 0; i < cones.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) EXPECT_GT((mesh.V.row(cones[i]) - mesh.V.row(cones[j])).norm(), 0.7);
  }
}

INSTANTIATE_TEST_SUITE_P(
    , SampleMeshes,
    testing::Values(SampleOptions{SampleShape::figure, 100}, SampleOptions{SampleShape::figure, 201},
                    SampleOptions{SampleShape::figure, 1500}, SampleOptions{SampleShape::figure, 3'001},
                    SampleOptions{SampleShape::figure, 12'000}, SampleOptions{SampleShape::mask, 100},
                    SampleOptions{SampleShape::mask, 201}, SampleOptions{SampleShape::mask, 1500},
                    SampleOptions{SampleShape::mask, 3'001}, SampleOptions{SampleShape::mask, 12'000}),
    [](const auto& each) { return name_of(each.param.shape) + std::to_string(each.param.faces); });

TEST(SampleMesh, FacesOutwards) {
  EXPECT_GT(enclosed_volume(sample_mesh({SampleShape::figure, 1000})), 0);
  EXPECT_GT(enclosed_volume(sample_mesh({SampleShape::mask, 1000})), 0);
}

TEST(SampleMesh, IsSmootherTheFinerItIs) {
  for (const SampleShape shape : {SampleShape::figure, SampleShape::mask}) {
    const double coarse = sharpest_edge(sample_mesh({shape, 5'000}));
    const double fine = sharpest_edge(sample_mesh({shape, 80'000}));
    EXPECT_LT(fine, 20 * kDegree) << name_of(shape);
    EXPECT_LT(fine, coarse / 2) << name_of(shape);
  }
}

TEST(SampleMesh, TheMaskEndsInOneSmoothCurveInAPlane) {
  const Mesh mesh = sample_mesh({SampleShape::mask, 5'000});
  const auto boundary = inspect(mesh).boundary;
  ASSERT_EQ(boundary.size(), 1u);
  const auto& curve = boundary[0];
  for (std::size_t i = 0; i < curve.size(); ++i) {
    const Vector3 a = mesh.V.row(curve[i]), b = mesh.V.row(curve[(i + 1) % curve.size()]),
                  c = mesh.V.row(curve[(i + 2) % curve.size()]);
    EXPECT_EQ(a[2], 0);
    EXPECT_GT((b - a).normalized().dot((c - b).normalized()), std::cos(15 * kDegree));
  }
}

TEST(SampleMesh, ThreeConesOfTheMaskFollowItsBoundary) {
  const Mesh mesh = sample_mesh({SampleShape::mask, 5'000});
  const std::vector<int> cones = sample_cones(SampleShape::mask, mesh);
  const std::vector<int> curve = inspect(mesh).boundary.at(0);
  std::vector<std::ptrdiff_t> places;
  for (int i = 0; i < 3; ++i)
    places.push_back(std::find(curve.begin(), curve.end(), cones[i]) - curve.begin());
  for (const auto place : places) ASSERT_LT(place, static_cast<std::ptrdiff_t>(curve.size()));
  std::rotate(places.begin(), std::min_element(places.begin(), places.end()), places.end());
  EXPECT_TRUE(std::is_sorted(places.begin(), places.end()));
  EXPECT_EQ(std::count(curve.begin(), curve.end(), cones[3]), 0);
}

TEST(SampleMesh, NumbersOfFacesOutOfRangeAreRefused) {
  EXPECT_THROW(sample_mesh({SampleShape::figure, 99}), ArgumentError);
  EXPECT_THROW(sample_mesh({SampleShape::mask, -1}), ArgumentError);
  EXPECT_THROW(sample_mesh({SampleShape::mask, 20'000'001}), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::sample_test
