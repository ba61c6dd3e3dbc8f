// SPDX-License-Identifier: MIT
// How a map deforms a surface, as programs for the cortex measure it.
#include "orbitutte/verify/strain.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

#include "hand_made.h"
#include "orbitutte/export/sphere_surface.h"
#include "orbitutte/export/value_colours.h"
#include "test_meshes.h"

namespace orbitutte::strain_test {
namespace {

Embedding onto(const Points& positions, const Triangles& faces) {
  Embedding embedding;
  embedding.positions = positions;
  embedding.triangles = faces;
  embedding.source_vertex.resize(positions.rows());
  std::iota(embedding.source_vertex.begin(), embedding.source_vertex.end(), 0);
  return embedding;
}

constexpr int area = 0, J = 1, R = 2, edge = 3;

// A bumpy sphere and its map to the round one.
struct BumpySphere {
  Mesh source = test::icosphere(3);
  Embedding embedding;

  BumpySphere() {
    embedding = onto(source.V, source.F);
    source = test::perturbed(source, 0.04, 3);
    source.V.col(0) *= 1.7;
    source.V *= 50;
  }
  SurfaceStrain strain(double radius = 0) const {
    return measure_strain(test::unjudged(source), embedding, radius);
  }
};

TEST(Strain, OfASphereOntoItselfIsNone) {
  const Mesh sphere = test::icosphere(3);
  for (const double size : {1.0, 100.0}) {
    Mesh source = sphere;
    source.V *= size;
    const SurfaceStrain strain = measure_strain(test::unjudged(source), onto(sphere.V, sphere.F));
    EXPECT_LT(strain.at_vertices.values.cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_LT(strain.on_faces.values.cwiseAbs().maxCoeff(), 1e-7);
    EXPECT_EQ(std::accumulate(strain.at_vertices.measured.begin(), strain.at_vertices.measured.end(), 0),
              sphere.V.rows());
  }
}

// So flat a cap that a linear map is the same everywhere.
TEST(Strain, OfALinearMapIsThatOfItsSingularValues) {
  Mesh source = test::round_disk(6);
  Points positions = 1e-4 * source.V;
  positions.col(2).setOnes();
  positions.rowwise().normalize();
  const Embedding embedding = onto(positions, source.F);
  Eigen::Matrix2d A;
  A << 3, 1, 0, 0.5;
  source.V.leftCols<2>() = (source.V.leftCols<2>() * A.transpose()).eval();
  const Eigen::Vector2d sigma = A.jacobiSvd().singularValues();
  const SurfaceStrain strain = measure_strain(test::unjudged(source), embedding, 1e4);
  for (const StrainMap& map : {strain.at_vertices, strain.on_faces})
    for (const auto& row : map.values.rowwise()) {
      EXPECT_NEAR(row[area], -std::log2(sigma[0] * sigma[1]), 1e-5);
      EXPECT_NEAR(row[J], -std::log2(sigma[0] * sigma[1]), 1e-5);
      EXPECT_NEAR(row[R], std::log2(sigma[0] / sigma[1]), 1e-5);
      EXPECT_LE(row[edge], std::log2(sigma[0]) + 1e-5);  // |log2| of a length is at most the largest
      EXPECT_GT(row[edge], 0);
    }
}

// 3 x 2: the corners of a triangle in its own plane.
Eigen::Matrix<double, 3, 2> laid_flat(const Points& V, const Eigen::RowVector3i& face) {
  const Vector3 a = V.row(face[0]), b = V.row(face[1]), c = V.row(face[2]);
  const Vector3 x = (b - a).normalized(), y = ((c - a) - x * x.dot(c - a)).normalized();
  Eigen::Matrix<double, 3, 2> corners;
  corners << 0, 0, x.dot(b - a), 0, x.dot(c - a), y.dot(c - a);
  return corners;
}

// The definitions, by the affine maps between triangles, for a sphere of a given radius.
Eigen::MatrixXd by_definition(const Mesh& source, const Points& image) {
  const Eigen::Index n = source.V.rows();
  Eigen::VectorXd source_area = Eigen::VectorXd::Zero(n), image_area = source_area, j = source_area,
                  r = source_area, faces = source_area, edges = source_area, degree = source_area;
  std::set<std::pair<int, int>> pairs;
  for (const auto& row : source.F.rowwise()) {
    const Eigen::RowVector3i face = row;
    const auto p = laid_flat(source.V, face), q = laid_flat(image, face);
    Eigen::Matrix2d P, Q;
    P << p.row(1) - p.row(0), p.row(2) - p.row(0);
    Q << q.row(1) - q.row(0), q.row(2) - q.row(0);
    const Eigen::Vector2d sigma = (P.inverse() * Q).jacobiSvd().singularValues();
    for (int k = 0; k < 3; ++k) {
      source_area[face[k]] += P.determinant() / 6;
      image_area[face[k]] += Q.determinant() / 6;
      j[face[k]] += sigma[0] * sigma[1];
      r[face[k]] += sigma[0] / sigma[1];
      ++faces[face[k]];
      pairs.insert(std::minmax(face[k], face[(k + 1) % 3]));
    }
  }
  for (const auto& [a, b] : pairs) {
    const double ratio = (image.row(a) - image.row(b)).norm() / (source.V.row(a) - source.V.row(b)).norm();
    for (const int v : {a, b}) edges[v] += std::abs(std::log2(ratio)), ++degree[v];
  }
  Eigen::MatrixXd result(n, 4);
  result << (image_area.array() / source_area.array()).log() / std::log(2),
      (j.array() / faces.array()).log() / std::log(2), (r.array() / faces.array()).log() / std::log(2),
      edges.array() / degree.array();
  return result;
}

TEST(Strain, IsThatOfTheDefinitions) {
  const BumpySphere bumpy;
  const Points image = 100 * bumpy.embedding.positions;
  const Eigen::MatrixXd expected = by_definition(bumpy.source, image);
  EXPECT_LT((bumpy.strain(100).at_vertices.values - expected).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Strain, ScalesByAConstant) {
  const BumpySphere bumpy;
  const SurfaceStrain one = bumpy.strain(1), hundred = bumpy.strain(100);
  const auto difference = (hundred.at_vertices.values - one.at_vertices.values).eval();
  EXPECT_LT((difference.col(area).array() - 2 * std::log2(100)).abs().maxCoeff(), 1e-9);
  EXPECT_LT((difference.col(J).array() - 2 * std::log2(100)).abs().maxCoeff(), 1e-9);
  EXPECT_EQ(hundred.at_vertices.values.col(R), one.at_vertices.values.col(R));
}

// A vertex on the seam is one vertex, and each of its edges counts once.
TEST(Strain, DoesNotKnowWhereTheMapIsCut) {
  const BumpySphere bumpy;
  Embedding cut = bumpy.embedding;
  const int v = 5;
  const auto copy = static_cast<int>(cut.positions.rows());
  cut.positions.conservativeResize(copy + 1, 3);
  cut.positions.row(copy) = cut.positions.row(v);
  cut.source_vertex.push_back(v);
  int seen = 0;
  for (int& corner : cut.triangles.reshaped())
    if (corner == v && ++seen % 2 == 0) corner = copy;
  ASSERT_GT(seen, 3);
  const SurfaceStrain strain = measure_strain(test::unjudged(bumpy.source), cut);
  EXPECT_LT((strain.at_vertices.values - bumpy.strain().at_vertices.values).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Strain, OfVerticesWithoutFacesIsZeroAndNotCounted) {
  BumpySphere bumpy;
  const SurfaceStrain before = bumpy.strain();
  const Eigen::Index n = bumpy.source.V.rows();
  for (Points* points : {&bumpy.source.V, &bumpy.embedding.positions}) {
    points->conservativeResize(n + 1, 3);
    points->row(n) << 0, 0, 1;
  }
  bumpy.embedding.source_vertex.push_back(static_cast<int>(n));
  const SurfaceStrain strain = bumpy.strain();
  EXPECT_FALSE(strain.at_vertices.measured.back());
  EXPECT_TRUE(strain.at_vertices.values.row(n).isZero(0));
  EXPECT_EQ(strain_statistics(strain.at_vertices)[J].mean, strain_statistics(before.at_vertices)[J].mean);
}

TEST(StrainStatistics, HoldPercentilesInTheirOrder) {
  const StrainMap map = BumpySphere().strain().at_vertices;
  for (const StrainStatistics& row : strain_statistics(map)) {
    EXPECT_TRUE(std::is_sorted(std::begin(row.percentiles), std::end(row.percentiles)));
    EXPECT_GE(row.mean_absolute, std::abs(row.mean));
  }
  StrainMap numbers;
  numbers.values.setZero(101, 4);
  numbers.values.col(J).setLinSpaced(0, 100);
  numbers.measured.assign(101, 1);
  const StrainStatistics row = strain_statistics(numbers)[J];
  for (std::size_t k = 0; k < std::size(StrainStatistics::percents); ++k)
    EXPECT_NEAR(row.percentiles[k], StrainStatistics::percents[k], 1e-12);
  EXPECT_NEAR(row.mean, 50, 1e-12);
}

TEST(SphereSurface, IsTheMapAtTheRadius) {
  const BumpySphere bumpy;
  const PolygonMesh sphere = sphere_surface(bumpy.embedding, 7);
  EXPECT_LT((sphere.V - 7 * bumpy.embedding.positions).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_EQ(to_triangle_mesh(sphere).F, bumpy.source.F);
  EXPECT_THROW(sphere_surface(bumpy.embedding, -1), ArgumentError);
  Embedding plane = bumpy.embedding;
  plane.target.space = Space::plane();
  EXPECT_THROW(sphere_surface(plane), ArgumentError);
}

TEST(ValueColours, OfLabelsAreThoseOfTheirTable) {
  VertexData data;
  data.values.resize(3, 1);
  data.values << 4, 1, -1;
  data.labels = {{1, "a", {1, 0, 0, 1}}, {4, "b", {0, 0.5, 1, 1}}};
  const Points colours = value_colours(data, 0).colours;
  EXPECT_EQ(colours.row(0), Eigen::RowVector3d(0, 0.5, 1));
  EXPECT_EQ(colours.row(1), Eigen::RowVector3d(1, 0, 0));
  EXPECT_EQ(colours(2, 0), colours(2, 1));  // grey
}

TEST(ValueColours, OfMeasuresAreWhiteAtZeroIfTheScaleContainsIt) {
  VertexData data;
  data.values.resize(3, 2);
  data.values << -1, 1, 0, 2, 0.5, std::nan("");
  const ValueColours shown = value_colours(data, 0);
  EXPECT_EQ(shown.low, -1);
  EXPECT_EQ(shown.high, 1);
  EXPECT_GT(shown.colours.row(1).minCoeff(), 0.85);
  EXPECT_GT(shown.colours(0, 2), shown.colours(0, 0));  // blue
  EXPECT_GT(shown.colours(2, 0), shown.colours(2, 2));  // red
  const ValueColours positive = value_colours(data, 1);
  EXPECT_EQ(positive.low, 1);
  EXPECT_GT(positive.colours.row(0).sum(), positive.colours.row(1).sum());
  EXPECT_EQ(positive.colours(2, 0), positive.colours(2, 2));
}

TEST(ValueColours, MapsAreFoundByNameOrNumber) {
  VertexData data;
  data.values.setZero(1, 2);
  EXPECT_EQ(find_map(data, "1"), 1);
  data.names = {"1", "J"};
  EXPECT_EQ(find_map(data, "1"), 0);
  EXPECT_EQ(find_map(data, "J"), 1);
  EXPECT_THROW(find_map(data, "2"), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::strain_test
