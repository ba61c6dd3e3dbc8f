// SPDX-License-Identifier: MIT
#include "orbitutte/solve/conformal_metric.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/solve/development.h"
#include "orbitutte/weights/weights.h"
#include "test_meshes.h"

namespace orbitutte::conformal_metric_test {
namespace {

using std::numbers::pi;

Space space_of(int k) { return k > 0 ? Space::sphere() : k < 0 ? Space::hyperbolic_plane() : Space::plane(); }

class TrianglesOfEverySpace : public testing::TestWithParam<int> {};

INSTANTIATE_TEST_SUITE_P(Geometry, TrianglesOfEverySpace, testing::Values(1, 0, -1), [](const auto& info) {
  return info.param > 0 ? "sphere" : info.param == 0 ? "plane" : "hyperboloid";
});

// A triangle between three points of the space.
const std::array<Eigen::Vector2d, 3> some_corners = {Eigen::Vector2d(0.1, -0.2), Eigen::Vector2d(0.6, 0.1),
                                                     Eigen::Vector2d(-0.1, 0.5)};

TEST_P(TrianglesOfEverySpace, HaveTheAnglesBetweenTheirSides) {
  const int k = GetParam();
  const Space space = space_of(k);
  std::array<Vector3, 3> p;
  for (int i = 0; i < 3; ++i) p[i] = space.lift(some_corners[i].x(), some_corners[i].y());
  std::array<double, 3> half_sn;
  for (int i = 0; i < 3; ++i) {
    const double half = space.distance(p[i], p[(i + 1) % 3]) / 2;
    half_sn[i] = k > 0 ? std::sin(half) : k < 0 ? std::sinh(half) : half;
  }
  const TriangleAngles triangle = triangle_angles(k, half_sn);
  EXPECT_FALSE(triangle.is_flat);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(triangle.angle[i], space.angle(p[i], p[(i + 1) % 3], p[(i + 2) % 3]), 1e-12);
}

// With the scales v of the corners, d angle = -(derivative of the form)/2: the sum over the sides of
// w (v_i - v_j) + w T (v_i + v_j) at each of its ends, T = -k tn^2.
TEST_P(TrianglesOfEverySpace, ChangeTheirAnglesAsTheCouplingsSay) {
  const int k = GetParam();
  const std::array<double, 3> half_sn = {0.31, 0.27, 0.22}, v = {0.3, -0.7, 0.4};
  const auto scaled = [&](double h) {
    std::array<double, 3> result;
    for (int i = 0; i < 3; ++i) result[i] = half_sn[i] * std::exp(h * (v[i] + v[(i + 1) % 3]) / 2);
    return triangle_angles(k, result);
  };
  constexpr double h = 1e-5;
  const TriangleAngles here = scaled(0), after = scaled(h), before = scaled(-h);
  for (int i = 0; i < 3; ++i) {
    double expected = 0;
    for (const int side : {i, (i + 2) % 3}) {
      const int other = side == i ? (i + 1) % 3 : side;
      const double square = k * half_sn[side] * half_sn[side], curved = -square / (1 - square);
      expected -= here.coupling[side] * (v[i] - v[other] + curved * (v[i] + v[other]));
    }
    EXPECT_NEAR((after.angle[i] - before.angle[i]) / (2 * h), expected, 1e-8) << "corner " << i;
  }
}

TEST_P(TrianglesOfEverySpace, AreFlatIfASideIsTooLong) {
  const TriangleAngles triangle = triangle_angles(GetParam(), {0.1, 0.3, 0.1});
  EXPECT_TRUE(triangle.is_flat);
  EXPECT_EQ(triangle.angle, (std::array<double, 3>{pi, 0, 0}));
}

// A closed surface with cones of one angle at its extremities, and its metric.
struct ConeSurface {
  ConeSurface(Mesh mesh, int count, double angle)
      : surface(make_surface(std::move(mesh))),
        space(angle * count > 2 * pi * (count - 2) ? Space::sphere() : Space::hyperbolic_plane()),
        cones(choose_extremities(surface, {count, 0})),
        angles(Eigen::VectorXd::Constant(surface.vertex_count(), 2 * pi)),
        weights(edge_weights(surface, {})) {
    for (const int v : cones) angles[v] = angle;
    const std::vector<std::array<int, 2>>& edges =
        weights.triangulation ? weights.triangulation->connectivity.edges : surface.connectivity.edges;
    const Dissection dissection = dissect(vertex_neighbors(edges, surface.vertex_count()));
    metric = conformal_metric({surface, space, angles, weights, dissection, available_backends().front()});
  }

  double area_by_gauss_and_bonnet() const {
    return space.curvature() * (angles.sum() - pi * surface.triangle_count());
  }

  Surface surface;
  Space space;
  std::vector<int> cones;
  Eigen::VectorXd angles;
  EdgeWeights weights;
  ConformalMetric metric;
};

// Five cones of 1.6 pi on the sphere, and of pi in the hyperbolic plane.
ConeSurface perturbed_sphere(double angle) {
  return {test::perturbed(test::icosphere(3), 0.03, 7), 5, angle};
}

TEST(ConformalMetric, HasTheAnglesThatWereAskedFor) {
  for (const double angle : {1.6 * pi, pi}) {
    const ConeSurface s = perturbed_sphere(angle);
    EXPECT_LT(s.metric.defect, 1e-4);
    Eigen::VectorXd sum = Eigen::VectorXd::Zero(s.surface.vertex_count());
    for (Eigen::Index f = 0; f < s.surface.triangles.rows(); ++f)
      for (int i = 0; i < 3; ++i) sum[s.surface.triangles(f, i)] += s.metric.angles(f, i);
    EXPECT_LT((sum - s.angles).cwiseAbs().maxCoeff(), 1e-4);
  }
}

// Lengths are scaled by factors of the vertices: around two triangles, the product of chords across from each
// other, divided by the other two, stays.
TEST(ConformalMetric, KeepsLengthCrossRatios) {
  const ConeSurface s = perturbed_sphere(pi);
  const auto chord = [&](int h) { return 2 * std::sinh(s.metric.lengths.data()[h] / 2); };
  const auto length = [&](int h) {
    return (s.surface.V.row(halfedge_origin(s.surface.triangles, h)) -
            s.surface.V.row(halfedge_target(s.surface.triangles, h)))
        .norm();
  };
  const auto cross_ratio = [&](int h, const auto& of) {
    const int g = s.surface.connectivity.opposite[h];
    return of(next_halfedge(h)) * of(next_halfedge(g)) /
           (of(previous_halfedge(h)) * of(previous_halfedge(g)));
  };
  for (int h = 0; h < static_cast<int>(s.surface.triangles.size()); ++h)
    EXPECT_NEAR(cross_ratio(h, chord) / cross_ratio(h, length), 1, 1e-9) << "half-edge " << h;
}

TEST(ConformalMetric, IsDevelopedWithItsLengthsAndItsArea) {
  for (const double angle : {1.6 * pi, pi}) {
    const ConeSurface s = perturbed_sphere(angle);
    const CutMesh cut = cut_along_tree(s.surface, s.cones, static_cast<int>(s.cones.size()), {});
    const Points x = developed(s.surface, cut, s.space, s.metric);
    double area = 0;
    for (int h = 0; h < static_cast<int>(cut.F.size()); ++h) {
      const double distance =
          s.space.distance(x.row(halfedge_origin(cut.F, h)), x.row(halfedge_target(cut.F, h)));
      EXPECT_NEAR(distance, s.metric.lengths.data()[h], 1e-3 * s.metric.lengths.maxCoeff());
    }
    for (Eigen::Index f = 0; f < cut.F.rows(); ++f) {
      const double one = s.space.area(x.row(cut.F(f, 0)), x.row(cut.F(f, 1)), x.row(cut.F(f, 2)));
      EXPECT_GT(one, 0);
      area += one;
    }
    EXPECT_NEAR(area, s.area_by_gauss_and_bonnet(), 1e-3);
  }
}

// A regular tetrahedron stays one: the angles at a cone of 1.6 pi are equal.
TEST(ConformalMetric, KeepsSymmetry) {
  const ConeSurface s(test::tetrahedron(), 4, 1.6 * pi);
  const double side = s.space.side_opposite(1.6 * pi / 3, 1.6 * pi / 3, 1.6 * pi / 3);
  for (Eigen::Index k = 0; k < s.metric.lengths.size(); ++k)
    EXPECT_NEAR(s.metric.lengths.data()[k], side, 1e-4);
}

}  // namespace
}  // namespace orbitutte::conformal_metric_test
