// SPDX-License-Identifier: MIT
#include "orbitutte/weights/weights.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "test_meshes.h"

namespace orbitutte::weights_test {
namespace {

using test::vertex_count;

EdgeWeights weights_of(const Mesh& mesh, const WeightOptions& options = {WeightKind::cotan}) {
  return edge_weights(test::unjudged(mesh), options);
}

/// The angle of a triangle with these sides opposite to the first: the law of cosines.
double angle_opposite(double a, double b, double c) {
  return std::acos(std::clamp((b * b + c * c - a * a) / (2 * b * c), -1.0, 1.0));
}

/// (cot a + cot b)/2 of every edge, before any clamp, from the lengths of the edges alone.
std::vector<double> cotangents_from_lengths(const Mesh& mesh) {
  const Connectivity connectivity = test::edges_of(mesh);
  const auto length = [&](int h) {
    return (mesh.V.row(halfedge_origin(mesh.F, h)) - mesh.V.row(halfedge_target(mesh.F, h))).norm();
  };
  std::vector<double> result(connectivity.edges.size(), 0.0);
  for (int h = 0; h < mesh.F.size(); ++h) {
    const double angle = angle_opposite(length(h), length(next_halfedge(h)), length(previous_halfedge(h)));
    result[connectivity.edge_of[h]] += 0.5 / std::tan(angle);
  }
  return result;
}

/// Spheres and disks with acute and obtuse angles, none of them right.
std::vector<Mesh> irregular_meshes() {
  std::vector<Mesh> result;
  for (const std::uint32_t seed : {1, 2, 3}) {
    result.push_back(test::perturbed(test::icosphere(2), 0.08, seed));
    result.push_back(test::perturbed(test::octasphere(2), 0.1, seed));
    result.push_back(test::perturbed(test::grid_disk(8, 5), 0.3, seed));
    result.push_back(test::perturbed(test::round_disk(5), 0.05, seed));
  }
  return result;
}

double largest_relative_change(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return ((a - b).array().abs() / a.array()).maxCoeff();
}

// --------------------------------------------------------------------------------------------- cotangents

TEST(Weights, AreTheCotangentsOfTheAnglesThatEdgeLengthsGive) {
  for (const Mesh& mesh : irregular_meshes()) {
    const std::vector<double> expected = cotangents_from_lengths(mesh);
    const EdgeWeights weights = weights_of(mesh);
    ASSERT_EQ(weights.w.size(), static_cast<Eigen::Index>(expected.size()));
    int negative = 0;
    for (std::size_t e = 0; e < expected.size(); ++e) {
      negative += expected[e] <= 0;
      EXPECT_NEAR(weights.w[e], expected[e] > 0 ? expected[e] : 0.01, 1e-10);
    }
    EXPECT_EQ(weights.clamped_edges, negative);
    EXPECT_EQ(weights.zero_edges, 0);
  }
}

TEST(Weights, OfRegularTrianglesAreCotangentsOfSixtyDegrees) {
  for (const double w : weights_of(test::icosahedron()).w) EXPECT_NEAR(w, 1 / std::sqrt(3), 1e-14);
  for (const double w : weights_of(test::octahedron()).w) EXPECT_NEAR(w, 1 / std::sqrt(3), 1e-14);
}

TEST(Weights, OfABoundaryEdgeComeFromItsOneTriangle) {
  const double angle = 0.7;
  const Mesh triangle =
      test::mesh({{0, 0, 0}, {1, 0, 0}, {std::cos(angle), std::sin(angle), 0}}, {{0, 1, 2}});
  const EdgeWeights weights = weights_of(triangle);  // edges 01, 02, 12
  const double base = (std::numbers::pi - angle) / 2;
  EXPECT_NEAR(weights.w[0], 0.5 / std::tan(base), 1e-14);
  EXPECT_NEAR(weights.w[1], 0.5 / std::tan(base), 1e-14);
  EXPECT_NEAR(weights.w[2], 0.5 / std::tan(angle), 1e-14);
}

TEST(Weights, SumUpTheDirichletEnergyOfThePositionsToTwiceTheArea) {
  // Sum over edges of w |x_i - x_j|^2 = 2 area, where nothing is clamped.
  const Mesh mesh = test::icosphere(2);
  const Connectivity connectivity = test::edges_of(mesh);
  const EdgeWeights weights = weights_of(mesh);
  ASSERT_EQ(weights.clamped_edges, 0);
  double energy = 0, area = 0;
  for (std::size_t e = 0; e < connectivity.edges.size(); ++e) {
    const auto [i, j] = connectivity.edges[e];
    energy += weights.w[e] * (mesh.V.row(i) - mesh.V.row(j)).squaredNorm();
  }
  for (int f = 0; f < mesh.F.rows(); ++f) {
    const Vector3 a = mesh.V.row(mesh.F(f, 0)), b = mesh.V.row(mesh.F(f, 1)), c = mesh.V.row(mesh.F(f, 2));
    area += (b - a).cross(c - a).norm() / 2;
  }
  EXPECT_NEAR(energy, 2 * area, 1e-12 * energy);
}

TEST(Weights, DoNotChangeByABitWithTheScale) {
  for (const Mesh& mesh : irregular_meshes()) {
    for (const double scale : {0x1p-60, 0x1p-1, 0x1p10, 0x1p60}) {
      Mesh scaled = mesh;
      scaled.V *= scale;
      EXPECT_EQ(weights_of(scaled).w, weights_of(mesh).w);
    }
  }
}

RC_GTEST_PROP(Weights, DoNotChangeWithRotationsAndTranslations, (std::uint32_t seed)) {
  std::mt19937 random(seed);
  const auto uniform = [&] { return 2.0 * random() / std::mt19937::max() - 1; };
  Mesh mesh = test::icosphere(1);
  const Eigen::VectorXd before = weights_of(mesh).w;
  const Matrix3 rotation =
      Eigen::Quaterniond(uniform(), uniform(), uniform(), uniform()).normalized().toRotationMatrix();
  mesh.V = (mesh.V * rotation.transpose()).eval();
  mesh.V.rowwise() += Vector3(uniform(), uniform(), uniform()).transpose();
  RC_ASSERT(largest_relative_change(before, weights_of(mesh).w) < 1e-12);
}

RC_GTEST_PROP(Weights, FollowTheEdgesWhenVerticesAreRelabelled, (std::uint32_t seed)) {
  const Mesh mesh = test::perturbed(test::grid_disk(4, 4), 0.3, seed);
  const std::vector<int> number = test::permutation(vertex_count(mesh), seed);
  const Mesh other = test::relabelled(mesh, number);
  const Connectivity before = test::edges_of(mesh), after = test::edges_of(other);
  const EdgeWeights expected = weights_of(mesh), weights = weights_of(other);
  for (std::size_t e = 0; e < before.edges.size(); ++e) {
    const auto [i, j] = before.edges[e];
    const std::array<int, 2> edge = {std::min(number[i], number[j]), std::max(number[i], number[j])};
    const auto at = std::lower_bound(after.edges.begin(), after.edges.end(), edge) - after.edges.begin();
    RC_ASSERT(std::abs(weights.w[at] - expected.w[e]) <= 1e-12 * (1 + expected.w[e]));
  }
}

// -------------------------------------------------------------------------------------- clamp, zero angles

TEST(Weights, OfRightAnglesAreExactZerosThatAreClampedAndCounted) {
  const int columns = 5, rows = 3;
  const Mesh mesh = test::grid_disk(columns, rows);
  const Connectivity connectivity = test::edges_of(mesh);
  for (const double clamp : {0.01, 0.25}) {
    const EdgeWeights weights = weights_of(mesh, {WeightKind::cotan, clamp});
    EXPECT_EQ(weights.clamp, clamp);
    EXPECT_EQ(weights.clamped_edges, columns * rows);
    for (std::size_t e = 0; e < connectivity.edges.size(); ++e) {
      const auto [i, j] = connectivity.edges[e];
      const bool diagonal = j - i == columns + 2;
      const bool outer = (j - i == 1 && (i <= columns || i >= rows * (columns + 1))) ||
                         (j - i == columns + 1 && (i % (columns + 1) == 0 || j % (columns + 1) == columns));
      EXPECT_EQ(weights.w[e], diagonal ? clamp : outer ? 0.5 : 1.0);
    }
  }
}

TEST(Weights, ClampReplacesExactlyThoseThatAreNotPositive) {
  for (const Mesh& mesh : irregular_meshes()) {
    const EdgeWeights small = weights_of(mesh, {WeightKind::cotan, 1e-3}),
                      large = weights_of(mesh, {WeightKind::cotan, 7});
    EXPECT_EQ(small.clamped_edges, large.clamped_edges);
    EXPECT_EQ((large.w.array() == 7).count(), large.clamped_edges);
    for (Eigen::Index e = 0; e < large.w.size(); ++e) {
      EXPECT_GT(small.w[e], 0);
      EXPECT_EQ(small.w[e], large.w[e] == 7 ? 1e-3 : large.w[e]);
    }
  }
}

TEST(Weights, OfTrianglesWithoutAreaAreFiniteAndPositive) {
  const Mesh collinear =
      test::mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {1, 1, 0}}, {{0, 1, 3}, {1, 2, 3}, {0, 2, 1}});
  const Mesh coincident = test::mesh({{0, 0, 0}, {1, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 3}, {1, 2, 3}});
  Mesh point = test::octahedron();
  point.V.setConstant(3);
  Mesh sliver = test::icosphere(1);
  sliver.V.row(0) = 0.5 * (sliver.V.row(12) + sliver.V.row(13));
  for (const Mesh& mesh : {collinear, coincident, point, sliver}) {
    const EdgeWeights weights = weights_of(mesh);
    EXPECT_TRUE(weights.w.allFinite());
    EXPECT_GT(weights.w.minCoeff(), 0);
  }
  EXPECT_EQ(weights_of(point).clamped_edges, 12);
}

TEST(Weights, TrianglesWithoutAreaAddNothing) {
  const Mesh without = test::mesh({{0, 0, 0}, {1, 0, 0}, {0.4, 0.8, 0}, {0.5, 0, 0}}, {{0, 1, 2}});
  const Mesh with = test::with_face(without, 1, 0, 3);
  const Connectivity connectivity = test::edges_of(with);
  EXPECT_EQ(connectivity.edges[0], (std::array<int, 2>{0, 1}));
  EXPECT_EQ(weights_of(with).w[0], weights_of(without).w[0]);
}

TEST(Weights, UniformOnesAreOne) {
  for (const Mesh& mesh : {test::icosphere(1), test::grid_disk(3, 2)}) {
    const EdgeWeights weights = weights_of(mesh, {WeightKind::uniform, 0.01});
    EXPECT_EQ(weights.kind, WeightKind::uniform);
    EXPECT_EQ(weights.w.size(), static_cast<Eigen::Index>(test::edges_of(mesh).edges.size()));
    EXPECT_TRUE((weights.w.array() == 1).all());
    EXPECT_EQ(weights.clamped_edges, 0);
  }
}

TEST(Weights, KindsHaveTheirNames) {
  EXPECT_EQ(name_of(WeightKind::cotan), "cotan");
  EXPECT_EQ(name_of(WeightKind::uniform), "uniform");
  EXPECT_EQ(name_of(WeightKind::file), "file");
}

TEST(Weights, ClampsThatAreNotPositiveAndFiniteAreRefused) {
  const auto refusal = [](const WeightOptions& options) -> std::string {
    try {
      weights_of(test::octahedron(), options);
      return {};
    } catch (const ArgumentError& error) {
      return error.what();
    }
  };
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  for (const auto& [clamp, text] : {std::pair(0.0, "0"), {-0.5, "-0.5"}, {infinity, "inf"}, {nan, "nan"}}) {
    EXPECT_EQ(refusal({WeightKind::cotan, clamp}),
              std::string("the clamp of the weights is ") + text + "; it must be positive and finite");
  }
  EXPECT_EQ(refusal({WeightKind::file, 0.01}),
            "the kind of the weights is 'file'; call read_weights to read them");
}

// --------------------------------------------------------------------------------------------- weight files

/// A tetrahedron's six edges.
const std::string six_lines = "0 1 1\n0 2 2\n0 3 3\n1 2 4\n1 3 5\n2 3 6\n";

std::string written(const std::string& text) {
  const std::string test_name = testing::UnitTest::GetInstance()->current_test_info()->name();
  const std::string path = testing::TempDir() + "orbitutte_weights_" + test_name + ".txt";
  std::ofstream(path, std::ios::binary) << text;
  return path;
}

EdgeWeights read(const std::string& text) {
  return read_weights(written(text), test::edges_of(test::tetrahedron()));
}

/// The sentence with which a file is refused, less the path that it begins with; empty where the file is
/// accepted.
std::string refusal_of_weights(const std::string& text) {
  const std::string path = written(text);
  try {
    read_weights(path, test::edges_of(test::tetrahedron()));
    return {};
  } catch (const MeshError& error) {
    const std::string sentence = error.what();
    EXPECT_EQ(sentence.substr(0, path.size() + 2), path + ": ");
    EXPECT_EQ(sentence.find('\n'), std::string::npos);
    return sentence.substr(path.size() + 2);
  }
}

void expect_one_to_six(const EdgeWeights& weights) {
  EXPECT_EQ(weights.kind, WeightKind::file);
  EXPECT_EQ(weights.w, (Eigen::VectorXd(6) << 1, 2, 3, 4, 5, 6).finished());
  EXPECT_EQ(weights.zero_edges, 0);
  EXPECT_EQ(weights.clamped_edges, 0);
}

TEST(WeightFile, GivesEveryEdgeItsWeight) { expect_one_to_six(read(six_lines)); }

TEST(WeightFile, MayGiveEdgesInAnyOrderAndDirection) {
  expect_one_to_six(read("3 2 6\n1 0 1\n3 1 5\n2 0 2\n2 1 4\n0 3 3\n"));
}

TEST(WeightFile, MayHoldCommentsBlankLinesAndFurtherColumns) {
  expect_one_to_six(read(
      "# i j w\n\n0 1 1 left 17\n  0 2 2 # two\n\t0\t3\t3\t\n   \n1 2 4\n  # indented\n1 3 5\n2 3 6\n\n"));
}

TEST(WeightFile, MayEndLinesLikeWindows) {
  std::string text = "# i j w\r\n\r\n";
  for (const char c : six_lines) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_one_to_six(read(text));
}

TEST(WeightFile, MayEndWithoutALineEnd) {
  expect_one_to_six(read(six_lines.substr(0, six_lines.size() - 1)));
}

TEST(WeightFile, MayWriteNumbersInAnyForm) {
  expect_one_to_six(read("0 1 1.0\n0 2 2e0\n0 3 .3e1\n1 2 4.\n1 3 0.05E2\n2 3 600e-2\n"));
}

TEST(WeightFile, KeepsZerosAndCountsThem) {
  const EdgeWeights weights = read("0 1 0\n0 2 2\n0 3 0.0\n1 2 4\n1 3 -0\n2 3 6\n");
  EXPECT_EQ(weights.zero_edges, 3);
  EXPECT_EQ(weights.w[0], 0);
  EXPECT_EQ(weights.w[1], 2);
}

RC_GTEST_PROP(WeightFile, ReadsBackEveryDoubleThatWasWritten, (std::uint32_t seed)) {
  std::mt19937_64 random(seed);
  std::string text;
  std::vector<double> expected;
  for (const auto& [i, j] : test::edges_of(test::tetrahedron()).edges) {
    expected.push_back(
        std::ldexp(static_cast<double>(random() >> 11), static_cast<int>(random() % 200) - 150));
    char number[40];
    std::snprintf(number, sizeof number, "%.17g", expected.back());
    text += std::to_string(i) + " " + std::to_string(j) + " " + number + "\n";
  }
  const EdgeWeights weights = read(text);
  RC_ASSERT(std::equal(expected.begin(), expected.end(), weights.w.begin()));
}

TEST(WeightFile, LinesForNoEdgeAreRefused) {
  EXPECT_EQ(refusal_of_weights(six_lines + "0 4 1\n"), "line 7: the mesh has no edge (0, 4); leave it out");
  EXPECT_EQ(refusal_of_weights("# i j w\n2 2 1\n" + six_lines),
            "line 2: the mesh has no edge (2, 2); leave it out");
  EXPECT_EQ(refusal_of_weights("0 -1 1\n"), "line 1: the mesh has no edge (0, -1); leave it out");
}

TEST(WeightFile, EdgesGivenTwiceAreRefused) {
  EXPECT_EQ(refusal_of_weights(six_lines + "1 2 4\n"),
            "line 7: edge (1, 2) is given twice; give every edge once");
  EXPECT_EQ(refusal_of_weights(six_lines + "\n2 1 9\n"),
            "line 8: edge (2, 1) is given twice; give every edge once");
}

TEST(WeightFile, MissingEdgesAreRefused) {
  EXPECT_EQ(refusal_of_weights("0 1 1\n0 2 2\n0 3 3\n1 3 5\n2 3 6\n"),
            "edge (1, 2) has no line; give every edge of the mesh once");
  EXPECT_EQ(refusal_of_weights(""), "edge (0, 1) has no line; give every edge of the mesh once");
}

TEST(WeightFile, WeightsThatAreNegativeOrNotFiniteAreRefused) {
  const std::string reason = "; weights must be finite and not negative";
  EXPECT_EQ(refusal_of_weights("0 1 -1\n"), "line 1: edge (0, 1) has the weight -1" + reason);
  EXPECT_EQ(refusal_of_weights("0 1 1\n0 2 -1e-300\n"),
            "line 2: edge (0, 2) has the weight -1e-300" + reason);
  EXPECT_EQ(refusal_of_weights("0 1 nan\n"), "line 1: edge (0, 1) has the weight nan" + reason);
  EXPECT_EQ(refusal_of_weights("0 1 inf\n"), "line 1: edge (0, 1) has the weight inf" + reason);
  EXPECT_EQ(refusal_of_weights("0 1 -inf\n"), "line 1: edge (0, 1) has the weight -inf" + reason);
}

TEST(WeightFile, LinesThatAreNotTwoVerticesAndAWeightAreRefused) {
  for (const std::string line : {"0", "0 1", "0 1 x", "a b c", "0 1 1,5", "0,1,1", "0.0 1 1", "0 1 1e999",
                                 "0 1 0x1", "99999999999 1 1", "0 1 #", "v 0 1 1",
                                 "\xef\xbb\xbf"
                                 "0 1 1"}) {
    EXPECT_EQ(refusal_of_weights("# i j w\n" + line + "\n" + six_lines),
              "line 2 is not 'i j w' (two vertices and a weight); mend it")
        << line;
  }
}

TEST(WeightFile, ThatDoesNotExistIsAFileError) {
  EXPECT_THROW(
      read_weights(testing::TempDir() + "orbitutte_no_such_weights.txt", test::edges_of(test::tetrahedron())),
      FileError);
  EXPECT_THROW(read_weights(testing::TempDir(), test::edges_of(test::tetrahedron())), FileError);
}

}  // namespace
}  // namespace orbitutte::weights_test
