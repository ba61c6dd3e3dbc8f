// SPDX-License-Identifier: MIT
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <set>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/samples/projective_mesh.h"
#include "orbitutte/samples/sample.h"

namespace orbitutte::projective_sample_test {
namespace {

constexpr std::array<EvenMap, 4> even_maps = {boys_surface, roman_surface, cross_cap, limbed_quotient};

Vector3 random_direction(std::mt19937& random) {
  std::normal_distribution<double> normal;
  return Vector3(normal(random), normal(random), normal(random)).normalized();
}

// How far a map is from taking antipodes to one point, near the equator too, where boys_surface changes the
// one of the two that it looks at.
double antipodal_difference(EvenMap map) {
  std::mt19937 random(7);
  double difference = 0;
  for (int k = 0; k < 1000; ++k) {
    Vector3 p = random_direction(random);
    if (k % 2) p = Vector3(p[0], p[1], 1e-14 * p[2]).normalized();
    difference = std::max(difference, (map(p) - map(-p)).norm());
    difference = std::max(difference, (map(p) - map(Vector3(-p[0], -p[1], p[2] * (k % 2 ? 1 : -1)))).norm());
  }
  return difference;
}

// Its first coordinate is odd.
Vector3 not_even(const Vector3& p) { return {p[0], p[2] * p[0], p[0] * p[1]}; }

TEST(EvenMaps, TakeAntipodesToOnePoint) {
  for (const EvenMap map : even_maps) EXPECT_LT(antipodal_difference(map), 1e-12);
  EXPECT_GT(antipodal_difference(not_even), 0.1);
}

TEST(EvenMaps, BoysSurfaceHasThreefoldSymmetry) {
  const auto turn = [](double angle) {
    return Eigen::AngleAxisd(angle, Vector3::UnitZ()).toRotationMatrix();
  };
  std::mt19937 random(11);
  for (int k = 0; k < 100; ++k) {
    const Vector3 p = random_direction(random);
    const Vector3 turned = boys_surface(turn(2 * std::numbers::pi / 3) * p), point = boys_surface(p);
    EXPECT_LT((turned - turn(-2 * std::numbers::pi / 3) * point).norm(), 1e-12);
  }
}

// The ratio of the singular values of a map's differential on the sphere.
double stretch_ratio(EvenMap map, const Vector3& p) {
  constexpr double step = 1e-5;
  const Vector3 u = p.unitOrthogonal(), v = p.cross(u);
  Eigen::Matrix<double, 3, 2> D;
  D.col(0) = (map((p + step * u).normalized()) - map((p - step * u).normalized())) / (2 * step);
  D.col(1) = (map((p + step * v).normalized()) - map((p - step * v).normalized())) / (2 * step);
  const Eigen::Vector2d s = D.jacobiSvd().singularValues();
  return s[0] / s[1];
}

TEST(EvenMaps, BoysSurfaceIsConformal) {
  std::mt19937 random(13);
  for (int k = 0; k < 200; ++k) EXPECT_NEAR(stretch_ratio(boys_surface, random_direction(random)), 1, 1e-6);
}

TEST(EvenMaps, TheQuotientIsImmersed) {
  std::mt19937 random(17);
  for (int k = 0; k < 2000; ++k) EXPECT_LT(stretch_ratio(limbed_quotient, random_direction(random)), 6);
}

class ProjectiveSamples : public testing::TestWithParam<SampleOptions> {
 protected:
  const Mesh mesh = sample_mesh(GetParam());
};

TEST_P(ProjectiveSamples, AreProjectivePlanesWithoutDefects) {
  const Inspection result = inspect(mesh);
  EXPECT_TRUE(result.defects.empty());
  EXPECT_EQ(result.topology, Topology::projective_plane);
  EXPECT_FALSE(result.orientable);
  EXPECT_EQ(result.euler_characteristic, 1);
  EXPECT_TRUE(result.boundary.empty());
  EXPECT_EQ(result.unreferenced_vertices, 0);
  EXPECT_EQ(result.zero_area_faces, 0);
}

TEST_P(ProjectiveSamples, HaveTheNearestNumberOfFaces) {
  const int asked = GetParam().faces, faces = static_cast<int>(mesh.F.rows());
  EXPECT_EQ(faces, projective_face_count(asked));
  EXPECT_LE(std::abs(faces - asked), std::sqrt(10.0 * asked));
  EXPECT_EQ(mesh.V.rows(), faces / 2 + 1);
}

TEST_P(ProjectiveSamples, AreTheSameEveryTime) {
  const Mesh again = sample_mesh(GetParam());
  EXPECT_EQ(mesh.V, again.V);
  EXPECT_EQ(mesh.F, again.F);
}

// The edges over which two faces disagree cut the plane open to a disk: a single closed curve.
TEST_P(ProjectiveSamples, AreOrientedButForOneClosedCurve) {
  const Connectivity connectivity = connectivity_of(mesh.F, static_cast<int>(mesh.V.rows()));
  std::vector<std::array<int, 2>> disagreeing;
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h) {
    const int other = connectivity.opposite[h];
    if (other > h && halfedge_origin(mesh.F, h) == halfedge_origin(mesh.F, other))
      disagreeing.push_back(connectivity.edges[connectivity.edge_of[h]]);
  }
  const Neighbors curve = vertex_neighbors(disagreeing, static_cast<int>(mesh.V.rows()));
  std::set<int> vertices;
  for (int v = 0; v < static_cast<int>(mesh.V.rows()); ++v) {
    const int degree = curve.start[v + 1] - curve.start[v];
    EXPECT_TRUE(degree == 0 || degree == 2) << v;
    if (degree) vertices.insert(v);
  }
  ASSERT_FALSE(vertices.empty());
  const int start = *vertices.begin();
  int steps = 0, before = -1;
  for (int v = start; steps == 0 || (v != start && steps <= static_cast<int>(vertices.size())); ++steps) {
    const int next = curve.neighbor[curve.start[v]] == before ? curve.start[v] + 1 : curve.start[v];
    before = v;
    v = curve.neighbor[next];
  }
  EXPECT_EQ(steps, static_cast<int>(vertices.size()));
}

TEST_P(ProjectiveSamples, HaveOneCone) {
  const std::vector<int> cones = sample_cones(GetParam().shape, mesh);
  ASSERT_EQ(cones.size(), 1u);
  EXPECT_EQ(mesh.V(cones[0], 2), mesh.V.col(2).maxCoeff());
}

std::vector<SampleOptions> projective_samples() {
  std::vector<SampleOptions> result;
  for (const SampleShape shape :
       {SampleShape::boy, SampleShape::roman, SampleShape::crosscap, SampleShape::quotient})
    for (const int faces : {10, 20, 30, 40, 90, 120, 160, 270, 1000, 5000, 20'000})
      result.push_back({shape, faces});
  return result;
}

INSTANTIATE_TEST_SUITE_P(, ProjectiveSamples, testing::ValuesIn(projective_samples()), [](const auto& each) {
  return name_of(each.param.shape) + std::to_string(each.param.faces);
});

TEST(ProjectiveMesh, IsAComplexAtEveryResolution) {
  for (int faces = 10; faces < 6000;) {
    for (const EvenMap map : even_maps) {
      const Inspection result = inspect(projective_mesh(map, faces));
      EXPECT_EQ(result.topology, Topology::projective_plane) << faces;
      EXPECT_EQ(result.zero_area_faces, 0) << faces;
    }
    const int made = projective_face_count(faces);
    while (projective_face_count(faces) == made) ++faces;
  }
}

TEST(ProjectiveMesh, HasEvenTrianglesOnImmersedSurfaces) {
  for (const SampleShape shape : {SampleShape::boy, SampleShape::quotient}) {
    const Inspection result = inspect(sample_mesh({shape, 20'000}));
    EXPECT_GT(result.min_angle, 0.2) << name_of(shape);
    EXPECT_LT(result.max_angle, 2.6) << name_of(shape);
  }
  EXPECT_GT(inspect(sample_mesh({SampleShape::boy, 20'000})).min_angle, 0.6);
}

TEST(ProjectiveMesh, OfBoysSurfaceHasItsSymmetry) {
  const Mesh mesh = sample_mesh({SampleShape::boy, 1000});
  const Matrix3 turn = Eigen::AngleAxisd(2 * std::numbers::pi / 3, Vector3::UnitZ()).toRotationMatrix();
  for (Eigen::Index v = 0; v < mesh.V.rows(); ++v) {
    const Vector3 turned = turn * mesh.V.row(v).transpose();
    EXPECT_LT((mesh.V.rowwise() - turned.transpose()).rowwise().norm().minCoeff(), 1e-10) << v;
  }
}

TEST(ProjectiveMesh, NumbersOfFacesOutOfRangeAreRefused) {
  EXPECT_THROW(sample_mesh({SampleShape::boy, 9}), ArgumentError);
  EXPECT_THROW(sample_mesh({SampleShape::roman, 20'000'001}), ArgumentError);
}

TEST(SampleShapes, AreKnownByName) {
  for (const SampleShape shape : {SampleShape::figure, SampleShape::mask, SampleShape::boy,
                                  SampleShape::roman, SampleShape::crosscap, SampleShape::quotient})
    EXPECT_EQ(parse_choice<SampleShape>(name_of(shape), "shape"), shape);
  EXPECT_THROW(parse_choice<SampleShape>("klein", "shape"), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::projective_sample_test
