// SPDX-License-Identifier: MIT
#include "orbitutte/verify/distortion.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>

#include "hand_made.h"
#include "sample_embeddings.h"

namespace orbitutte::distortion_test {
namespace {

// A map to the sphere is all that distortion asks for: seams and cones stay empty.
Embedding onto(const Points& positions, const Triangles& faces) {
  Embedding embedding;
  embedding.positions = positions;
  embedding.triangles = faces;
  embedding.source_vertex.resize(positions.rows());
  std::iota(embedding.source_vertex.begin(), embedding.source_vertex.end(), 0);
  return embedding;
}

// A round disk so small that the sphere is flat under it, around the north pole, and its source: the same
// disk, flat, with its coordinates multiplied.
struct FlatDisk {
  Mesh source = test::round_disk(6);
  Embedding embedding;

  FlatDisk(double x, double y) {
    Points positions = 1e-4 * source.V;
    positions.col(2).setOnes();
    positions.rowwise().normalize();
    embedding = onto(positions, source.F);
    source.V.col(0) *= x;
    source.V.col(1) *= y;
  }
  Distortion distortion() const { return measure_distortion(test::unjudged(source), embedding); }
};

void expect_same(const Distortion& a, const Distortion& b, double tolerance) {
  EXPECT_NEAR(a.area.mean, b.area.mean, tolerance);
  EXPECT_NEAR(a.area.std, b.area.std, tolerance);
  EXPECT_NEAR(a.area.median, b.area.median, tolerance);
  EXPECT_NEAR(a.area.max, b.area.max, tolerance * b.area.max);
  EXPECT_NEAR(a.angle.mean, b.angle.mean, tolerance);
  EXPECT_NEAR(a.angle.median, b.angle.median, tolerance);
  EXPECT_NEAR(a.angle.area_mean, b.angle.area_mean, tolerance);
  EXPECT_NEAR(a.angle.max, b.angle.max, tolerance * b.angle.max);
  EXPECT_NEAR(a.within_4, b.within_4, tolerance);
  EXPECT_NEAR(a.below_64, b.below_64, tolerance);
  EXPECT_NEAR(a.sigma, b.sigma, tolerance);
  EXPECT_EQ(a.measured_faces, b.measured_faces);
}

long long sum(const std::vector<long long>& counts) {
  return std::accumulate(counts.begin(), counts.end(), 0LL);
}

TEST(Distortion, IdentityOfAFineSphereHasNone) {
  const Mesh sphere = test::icosphere(4);
  const Distortion distortion = measure_distortion(test::unjudged(sphere), onto(sphere.V, sphere.F));
  EXPECT_EQ(distortion.measured_faces, test::face_count(sphere));
  EXPECT_NEAR(distortion.area.mean, 1, 1e-3);
  EXPECT_NEAR(distortion.area.max, 1, 3e-3);
  EXPECT_NEAR(distortion.area.median, 1, 1e-3);
  EXPECT_NEAR(distortion.angle.mean, 1, 3e-3);
  EXPECT_NEAR(distortion.angle.max, 1, 3e-3);
}

// The finer the mesh, the flatter its triangles.
TEST(Distortion, IdentityOfASphereConverges) {
  double before = 1;
  for (const int levels : {1, 2, 3, 4}) {
    const Mesh sphere = test::octasphere(levels);
    const Distortion distortion = measure_distortion(test::unjudged(sphere), onto(sphere.V, sphere.F));
    EXPECT_LT(distortion.angle.max - 1, 0.6 * before) << levels;
    before = distortion.angle.max - 1;
  }
}

TEST(Distortion, SourceThatIsTheEmbeddedTileItselfHasNone) {
  for (const char* signature : {"532", "*532", "12,12"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    // Cut open: the tile's vertices are a mesh of their own.
    const Mesh tile = {sample.embedding().positions, sample.embedding().triangles};
    const Distortion distortion = measure_distortion(test::unjudged(tile), onto(tile.V, tile.F));
    EXPECT_EQ(distortion.measured_faces, test::face_count(tile)) << signature;
    EXPECT_NEAR(distortion.area.median, 1, 0.03) << signature;
    EXPECT_NEAR(distortion.angle.mean, 1, 0.05) << signature;
    EXPECT_GE(distortion.area.mean, 1);
    EXPECT_GE(distortion.angle.mean, 1);
  }
}

TEST(Distortion, SimilarFlatSourceHasNone) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    const Distortion distortion = FlatDisk(scale, scale).distortion();
    EXPECT_NEAR(distortion.area.mean, 1, 1e-7);
    EXPECT_NEAR(distortion.area.std, 0, 1e-7);
    EXPECT_NEAR(distortion.area.max, 1, 1e-7);
    EXPECT_NEAR(distortion.angle.mean, 1, 1e-7);
    EXPECT_NEAR(distortion.angle.max, 1, 1e-7);
  }
}

TEST(Distortion, StretchOfTheSourceIsTheRatioOfSingularValues) {
  for (const double stretch : {0.1, 0.5, 2.0, 3.0, 100.0}) {
    const double ratio = std::max(stretch, 1 / stretch);
    for (const Distortion& distortion : {FlatDisk(stretch, 1).distortion(), FlatDisk(1, stretch).distortion(),
                                         FlatDisk(7, 7 * stretch).distortion()}) {
      EXPECT_NEAR(distortion.angle.mean, ratio, 1e-6 * ratio);
      EXPECT_NEAR(distortion.angle.max, ratio, 1e-6 * ratio);
      EXPECT_NEAR(distortion.area.max, 1, 1e-6);  // of all triangles alike
    }
  }
}

TEST(Distortion, ShearOfTheSourceIsTheRatioOfSingularValues) {
  FlatDisk disk(1, 1);
  disk.source.V.col(0) += 1.5 * disk.source.V.col(1);
  Eigen::Matrix2d shear;
  shear << 1, 1.5, 0, 1;
  const Eigen::Vector2d sigma = shear.jacobiSvd().singularValues();
  const Distortion distortion = disk.distortion();
  EXPECT_NEAR(distortion.angle.mean, sigma[0] / sigma[1], 1e-6);
  EXPECT_NEAR(distortion.angle.max, sigma[0] / sigma[1], 1e-6);
}

TEST(Distortion, MovingTheSourceRigidlyAndScalingItChangesNothing) {
  for (const char* signature : {"532", "*22"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Distortion before = measure_distortion(test::unjudged(sample.mesh), sample.embedding());
    Mesh moved = sample.mesh;
    moved.V = 37 * moved.V * hand_made::rotation({1, 2, 3}, 0.4);
    moved.V.rowwise() += Eigen::RowVector3d(5, -2, 8);
    expect_same(measure_distortion(test::unjudged(moved), sample.embedding()), before, 1e-10);
    moved.V = moved.V * hand_made::reflection({1, 0, 2});  // the inside of a surface measures as its outside
    expect_same(measure_distortion(test::unjudged(moved), sample.embedding()), before, 1e-10);
  }
}

TEST(Distortion, RotatingTheSphereChangesNothing) {
  const test::SampleEmbedding& sample = test::sample_embedding("33");
  Embedding turned = sample.embedding();
  turned.positions = turned.positions * hand_made::rotation({1, -1, 3}, 2);
  expect_same(measure_distortion(test::unjudged(sample.mesh), turned), sample.result.distortion, 1e-10);
}

// Two triangles whose shares of the sources' area are 1/4 and 3/4, and of the tile's 1/2 each.
TEST(Distortion, AreaDistortionIsTheRatioOfSharesOrItsInverse) {
  const Mesh source = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 0, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const Embedding embedding = onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {}).V, source.F);
  const Distortion::Area area = measure_distortion(test::unjudged(source), embedding).area;
  EXPECT_NEAR(area.max, 2, 1e-12);
  EXPECT_NEAR(area.mean, (2 + 1.5) / 2, 1e-12);
  EXPECT_NEAR(area.median, (2 + 1.5) / 2, 1e-12);
  EXPECT_NEAR(area.std, 0.25, 1e-12);
}

TEST(Distortion, MedianOfAnOddNumberIsTheMiddleOne) {
  // Octants of equal area from triangles of the areas 1/2, 1, 3/2: the ratios 2, 1, 2/3.
  const Mesh source = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-2, 0, 0}, {0, -1.5, 0}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
  const Embedding embedding =
      onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {}).V, source.F);
  const Distortion distortion = measure_distortion(test::unjudged(source), embedding);
  EXPECT_EQ(distortion.measured_faces, 3);
  EXPECT_NEAR(distortion.area.median, 1.5, 1e-12);
  EXPECT_NEAR(distortion.area.max, 2, 1e-12);
  EXPECT_NEAR(distortion.area.mean, 1.5, 1e-12);
}

// Octants of equal area from triangles whose areas are so many parts of the source: the triangle k has
// A = (1/3)/parts[k].
Distortion of_octants(const std::array<double, 3>& parts) {
  // Three triangles around the origin, their outer corners on the axes: areas |p0 p1|/2, |p1 p2|/2, |p2
  // p3|/2.
  const double p0 = 1, p1 = parts[0] / p0, p2 = parts[1] / p1, p3 = parts[2] / p2;
  const Mesh source = test::mesh({{0, 0, 0}, {p0, 0, 0}, {0, p1, 0}, {-p2, 0, 0}, {0, -p3, 0}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
  return measure_distortion(
      test::unjudged(source),
      onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {}).V, source.F));
}

TEST(Distortion, SharesWithinAndBelowAFactorAreAreasOfTheSource) {
  Distortion distortion = of_octants({0.3, 0.3, 0.4});  // A = 1.11, 1.11, 0.83
  EXPECT_NEAR(distortion.within_4, 1, 1e-12);
  EXPECT_EQ(distortion.below_64, 0);
  distortion = of_octants({0.05, 0.1, 0.85});  // A = 6.7, 3.3, 0.39
  EXPECT_NEAR(distortion.within_4, 0.95, 1e-12);
  EXPECT_EQ(distortion.below_64, 0);
  // Nearly all of the source in a sliver of the tile.
  const Mesh source = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-100, 0, 0}}, {{0, 1, 2}, {0, 2, 3}});
  Embedding embedding = onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-0.01, 1, 0}}, {}).V, source.F);
  embedding.positions.rowwise().normalize();
  distortion = measure_distortion(test::unjudged(source), embedding);
  EXPECT_NEAR(distortion.below_64, 100.0 / 101, 1e-12);
  EXPECT_EQ(distortion.within_4, 0);
}

TEST(Distortion, SigmaIsTheDeviationOfTheLogarithmOfTheScale) {
  const std::array<double, 3> parts = {0.1, 0.3, 0.6};
  double mean = 0, squares = 0;
  for (const double part : parts) mean += part * 0.5 * std::log(1 / (3 * part));
  for (const double part : parts) squares += part * std::pow(0.5 * std::log(1 / (3 * part)) - mean, 2);
  EXPECT_NEAR(of_octants(parts).sigma, std::sqrt(squares), 1e-12);
}

TEST(Distortion, AngleMeansAreOverFacesAndOverAreas) {
  FlatDisk disk(1, 2);
  const Distortion before = disk.distortion();
  EXPECT_NEAR(before.angle.area_mean, 2, 1e-6);  // all triangles alike
  EXPECT_NEAR(before.angle.median, 2, 1e-6);
  const Distortion distortion = of_octants({0.1, 0.3, 0.6});
  EXPECT_GE(distortion.angle.median, 1);
  EXPECT_LE(distortion.angle.median, distortion.angle.max);
  double weighted = 0;
  const double p1 = 0.1, p2 = 0.3 / p1, p3 = 0.6 / p2;
  const std::array<std::pair<double, double>, 3> legs = {{{1, p1}, {p1, p2}, {p2, p3}}};
  // From right triangles with these legs to the equilateral one that has the octant's arcs.
  for (const auto& [a, b] : legs) {
    Eigen::Matrix2d source, image;
    source << a, 0, 0, b;
    image << 1, 0.5, 0, std::sqrt(0.75);
    const Eigen::Vector2d sigma =
        Eigen::JacobiSVD<Eigen::Matrix2d>(image * source.inverse()).singularValues();
    weighted += a * b * sigma[0] / sigma[1];
  }
  EXPECT_NEAR(distortion.angle.area_mean, weighted, 1e-9 * weighted);
}

// A face that is turned over is part of the surface, but its scale is not known.
TEST(Distortion, WhatIsLeftOutIsInNoShare) {
  const Mesh source = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-1.5, 0, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const Embedding embedding = onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {1, 0, 0}}, {}).V, source.F);
  const Distortion distortion = measure_distortion(test::unjudged(source), embedding);
  EXPECT_EQ(distortion.measured_faces, 1);
  EXPECT_NEAR(distortion.within_4, 0.4, 1e-12);
  EXPECT_EQ(distortion.below_64, 0);
}

TEST(Distortion, FacesWithoutAreaAreLeftOut) {
  Mesh source = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 0, 0}, {-4, 0, 0}},
                           {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
  Embedding embedding =
      onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {}).V, source.F);
  Distortion distortion =
      measure_distortion(test::unjudged(source), embedding);  // the source's last face is a line
  EXPECT_EQ(distortion.measured_faces, 2);
  EXPECT_EQ(sum(distortion.histogram.counts), 2);
  EXPECT_TRUE(std::isfinite(distortion.area.max));
  EXPECT_TRUE(std::isfinite(distortion.angle.max));

  source.V.row(4) << -4, -3, 0;
  embedding.positions.row(4) = embedding.positions.row(0);  // now the image has no area
  distortion = measure_distortion(test::unjudged(source), embedding);
  EXPECT_EQ(distortion.measured_faces, 2);
  EXPECT_TRUE(std::isfinite(distortion.area.max));

  embedding.positions.row(4) << 0, 1, 0;  // and now it is turned over
  EXPECT_EQ(measure_distortion(test::unjudged(source), embedding).measured_faces, 2);
}

TEST(Distortion, MapsThatAreTurnedOverOrCollapsedAreMeasuredWithoutACrash) {
  const test::SampleEmbedding& sample = test::sample_embedding("33");
  Embedding embedding = sample.embedding();
  embedding.positions = -embedding.positions;
  EXPECT_EQ(measure_distortion(test::unjudged(sample.mesh), embedding).measured_faces, 0);
  embedding.positions.rowwise() = Eigen::RowVector3d(0, 0, 1);
  EXPECT_EQ(measure_distortion(test::unjudged(sample.mesh), embedding).measured_faces, 0);
  embedding.positions.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_EQ(measure_distortion(test::unjudged(sample.mesh), embedding).measured_faces, 0);
  embedding = sample.embedding();
  embedding.triangles.topRows(200).col(1).swap(
      embedding.triangles.topRows(200).col(2));  // more than half of it
  const Distortion distortion = measure_distortion(test::unjudged(sample.mesh), embedding);
  EXPECT_EQ(distortion.measured_faces, test::face_count(sample.mesh) - 200);
  EXPECT_GE(distortion.area.mean, 1);
}

TEST(Distortion, HugeAndTinySourcesAreMeasuredAlike) {
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  for (const double scale : {1e-200, 1e-100, 1e100, 1e200, 1e307}) {
    Mesh mesh = sample.mesh;
    mesh.V *= scale;
    expect_same(measure_distortion(test::unjudged(mesh), sample.embedding()), sample.result.distortion, 1e-9);
  }
}

TEST(Distortion, NothingToMeasureIsNoError) {
  const Distortion distortion = measure_distortion(test::unjudged(Mesh()), Embedding());
  EXPECT_EQ(distortion.measured_faces, 0);
  EXPECT_EQ(sum(distortion.histogram.counts), 0);
  EXPECT_EQ(distortion.area.mean, 0);
  EXPECT_EQ(distortion.angle.mean, 0);
  const Mesh flat = {Points::Zero(3, 3), test::mesh({}, {{0, 1, 2}}).F};
  EXPECT_EQ(measure_distortion(test::unjudged(flat), onto(Points::Identity(3, 3), flat.F)).measured_faces, 0);
}

TEST(Distortion, HistogramCountsEveryMeasuredFaceOnce) {
  for (const char* signature : {"532", "2,2,12", "*12,12"}) {
    const Distortion& distortion = test::sample_embedding(signature).result.distortion;
    const Distortion::Histogram& histogram = distortion.histogram;
    EXPECT_EQ(histogram.edges.size(), histogram.counts.size() + 1);
    EXPECT_TRUE(std::is_sorted(histogram.edges.begin(), histogram.edges.end()));
    EXPECT_EQ(sum(histogram.counts), distortion.measured_faces);
    for (const long long count : histogram.counts) EXPECT_GE(count, 0);
  }
}

TEST(Distortion, HistogramHoldsTheLogarithmOfTheAreaRatio) {
  const Mesh source = test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {-3, 0, 0}}, {{0, 1, 2}, {0, 2, 3}});
  const Embedding embedding = onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}, {}).V, source.F);
  const Distortion::Histogram histogram = measure_distortion(test::unjudged(source), embedding).histogram;
  for (const double value : {std::log2(2.0) + 1e-9, std::log2(2.0 / 3)}) {
    const auto above = std::upper_bound(histogram.edges.begin(), histogram.edges.end(), value);
    const auto bin = above - histogram.edges.begin() - 1;
    EXPECT_EQ(histogram.counts[bin] + histogram.counts[bin - 1], 1) << value;
  }
}

// Ratios beyond the last bounds fall into the first and the last bin.
TEST(Distortion, HistogramIsOpenAtBothEnds) {
  const double tiny = 1e-9;
  const Mesh source = test::mesh({{0, 0, 0}, {tiny, 0, 0}, {0, tiny, 0}, {-1, 0, 0}, {0, -1, 0}},
                                 {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}});
  const Embedding embedding =
      onto(test::mesh({{0, 0, 1}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}, {0, -1, 0}}, {}).V, source.F);
  const Distortion distortion = measure_distortion(test::unjudged(source), embedding);
  EXPECT_EQ(distortion.measured_faces, 3);
  EXPECT_EQ(distortion.histogram.counts.back(), 2);
  EXPECT_EQ(sum(distortion.histogram.counts), 3);
}

TEST(Distortion, IsTheMeanOverTheFaces) {
  const test::SampleEmbedding& sample = test::sample_embedding("432");
  double area = 0, angle = 0;
  const std::vector<FaceDistortion> faces =
      measure_triangles(test::unjudged(sample.mesh), sample.embedding());
  for (const FaceDistortion& face : faces) area += std::max(face.area, 1 / face.area), angle += face.angle;
  EXPECT_NEAR(area / static_cast<double>(faces.size()), sample.result.distortion.area.mean, 1e-9);
  EXPECT_NEAR(angle / static_cast<double>(faces.size()), sample.result.distortion.angle.mean, 1e-9);
}

TEST(Distortion, IsNeverBelowOne) {
  for (const std::string& signature : test::sample_signatures()) {
    const Distortion& distortion = test::sample_embedding(signature).result.distortion;
    EXPECT_GE(distortion.area.mean, 1);
    EXPECT_GE(distortion.area.median, 1);
    EXPECT_GE(distortion.area.max, distortion.area.mean);
    EXPECT_GE(distortion.area.max, distortion.area.median);
    EXPECT_GE(distortion.angle.mean, 1);
    EXPECT_GE(distortion.angle.max, distortion.angle.mean);
    EXPECT_GE(distortion.area.std, 0);
  }
}

}  // namespace
}  // namespace orbitutte::distortion_test
