// SPDX-License-Identifier: MIT
// Maps that shrink beyond what doubles resolve: their certificate, files and distortion.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>

#include "limb.h"
#include "orbitutte/orbifold/exact_positions.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/verify/certificate.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte::offsets_test {
namespace {

using test::Exact;
using test::Limb;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Names = std::set<std::string>;

Names failed_checks(const Certificate& certificate) {
  Names names;
  for (const Check& check : certificate.checks) {
    if (!check.passed) names.insert(check.name);
    EXPECT_EQ(check.passed, check.detail.empty()) << check.name;
  }
  return names;
}

Names rejection(const Limb& limb, const Embedding& embedding) {
  const Certificate certificate = certify(limb.surface(), embedding);
  EXPECT_FALSE(certificate.bijective);
  return failed_checks(certificate);
}

// Moves a vertex, all digits kept.
void move(Embedding& embedding, int v, const Exact& step, double scale) {
  const Exact moved = ExactPositions(embedding).exact(v) + step;
  test::store(embedding, v, moved / sqrt(moved.squaredNorm()), scale);
}

Exact towards(const Embedding& embedding, int from, int to, double share) {
  const ExactPositions positions(embedding);
  return MostPrecise(share) * (positions.exact(to) - positions.exact(from));
}

// Exact positions

TEST(ExactPositions, DifferencesAndSignsAreThoseOfTheSums) {
  Limb limb(1.0 / 8, 40);  // to 1e-36
  const ExactPositions positions(limb.embedding);
  const PreciseGroup<MostPrecise> group(limb.embedding.target);
  ASSERT_TRUE(positions.has_offsets());
  EXPECT_FALSE(positions.has_offsets(limb.vertex(0, 2)));
  for (const int ring : {1, 10, 25, 39}) {
    const int a = limb.vertex(ring, 1), b = limb.vertex(ring, 2), c = limb.vertex(ring + 1, 1);
    const Exact exact = limb.point(group, ring, 2) - limb.point(group, ring, 1);
    const Vector3 difference = positions.difference(a, b);
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(difference[k] / static_cast<double>(exact[k]), 1, 1e-14) << ring;
    EXPECT_NEAR(positions.chord(a, b) / limb.scale(ring),
                positions.chord(limb.vertex(0, 1), limb.vertex(0, 2)), 0.5);
    EXPECT_EQ(positions.orientation(a, b, c), 1);
    EXPECT_EQ(positions.orientation(b, a, c), -1);
    EXPECT_EQ(positions.orientation(a, b, b), 0);
  }
}

TEST(ExactPositions, SignsAreExactWhereThreePointsAlmostLieOnALine) {
  Embedding embedding;
  embedding.positions.resize(3, 3);
  embedding.positions << 0, 0, 1, 1e-20, 0, 1, 2e-20, 0, 1;
  embedding.source_vertex = {0, 1, 2};
  EXPECT_EQ(ExactPositions(embedding).orientation(0, 1, 2), 0);
  for (const double sign : {1.0, -1.0}) {
    embedding.offsets = {{2, {0, sign * 1e-300, 0}}};
    EXPECT_EQ(ExactPositions(embedding).orientation(0, 1, 2), sign);
    embedding.offsets = {{0, {0, 0, 0}}, {2, {0, 3, 0}}, {2, {0, -3, 0}}, {2, {0, sign * 5e-324, 0}}};
    EXPECT_EQ(ExactPositions(embedding).orientation(0, 1, 2), sign);
  }
}

TEST(ExactPositions, OffsetsOfZeroAreNone) {
  Embedding embedding;
  embedding.positions = Points::Ones(2, 3);
  embedding.offsets = {{1, Vector3::Zero()}};
  EXPECT_FALSE(ExactPositions(embedding).has_offsets());
}

// The certificate

TEST(CertificateOfOffsets, LimbsOfAnyLengthAreBijective) {
  for (const auto& [factor, rings] :
       {std::pair(0.5, 20), {1.0 / 8, 20}, {1.0 / 8, 40}, {1e-3, 33}, {1e-8, 12}, {1.0 / 16, 200}}) {
    const Limb limb(factor, rings);
    SCOPED_TRACE(limb.scale(rings));
    const Certificate certificate = certify(limb.surface(), limb.embedding);
    EXPECT_THAT(failed_checks(certificate), IsEmpty());
    EXPECT_TRUE(certificate.bijective);
  }
}

TEST(CertificateOfOffsets, ReadersThatIgnoreThemSeeAMapThatIsNotBijective) {
  Limb limb(1.0 / 8, 40);
  limb.embedding.offsets.clear();
  EXPECT_THAT(rejection(limb, limb.embedding), Contains("positive_faces"));
}

TEST(CertificateOfOffsets, FlipsOfAnySizeAreSeen) {
  const Limb limb(1.0 / 10, 32);
  for (const int ring : {1, 2, 5, 10, 15, 20, 25, 30}) {
    SCOPED_TRACE(limb.scale(ring));
    Embedding embedding = limb.embedding;
    const int v = limb.vertex(ring, 2);  // beyond the ring around it
    move(embedding, v, towards(embedding, v, limb.vertex(ring - 1, 2), 1.5), limb.scale(ring));
    EXPECT_THAT(rejection(limb, embedding), Contains("positive_faces"));
    EXPECT_THAT(certify(limb.surface(), embedding).nonpositive_faces,
                Contains(limb.first_face(ring - 1) + 3));
  }
}

TEST(CertificateOfOffsets, SmallMovesInsideAreNoFault) {
  const Limb limb(1.0 / 10, 32);
  for (const int ring : {1, 10, 30}) {
    Embedding embedding = limb.embedding;
    const int v = limb.vertex(ring, 2);
    move(embedding, v, towards(embedding, v, limb.vertex(ring, 1), 1e-2), limb.scale(ring));
    EXPECT_TRUE(certify(limb.surface(), embedding).bijective) << ring;
  }
}

TEST(CertificateOfOffsets, SeamsHaveToMatchAtTheScaleOfTheirEdges) {
  const Limb limb(1.0 / 10, 32);
  for (const int ring : {1, 8, 16, 24, 31}) {
    SCOPED_TRACE(limb.scale(ring));
    const auto with_step = [&](double share) {
      Embedding embedding = limb.embedding;
      const int v = limb.vertex(ring, 0);
      move(embedding, v, towards(embedding, v, limb.vertex(ring + 1, 0), share), 1e-6 * limb.scale(ring));
      return embedding;
    };
    if (ring > 12) {
      EXPECT_TRUE(certify(limb.surface(), with_step(1e-6)).bijective);
    }
    EXPECT_THAT(rejection(limb, with_step(0.2)), Contains("seam_residual"));
    EXPECT_THAT(rejection(limb, with_step(1e-2)), Contains("seam_residual"));
  }
}

TEST(CertificateOfOffsets, SwappedSeamVerticesAreSeen) {
  const Limb limb(1.0 / 10, 32);
  for (const int ring : {1, 10, 20, 30}) {
    SCOPED_TRACE(limb.scale(ring));
    Embedding embedding = limb.embedding;
    const ExactPositions positions(limb.embedding);
    test::store(embedding, limb.vertex(ring, 0), positions.exact(limb.vertex(ring + 1, 0)),
                limb.scale(ring + 1));
    test::store(embedding, limb.vertex(ring + 1, 0), positions.exact(limb.vertex(ring, 0)), limb.scale(ring));
    EXPECT_THAT(rejection(limb, embedding), Contains("seam_residual"));
  }
}

TEST(CertificateOfOffsets, TamperedOffsetsAreSeen) {
  const Limb limb(1.0 / 10, 32);
  for (const int ring : {18, 24, 31}) {  // whose edges are much shorter than the first offset of a vertex
    for (const int j : {0, 1, 2, 4}) {
      SCOPED_TRACE(limb.scale(ring));
      Embedding embedding = limb.embedding;
      const auto offset = std::find_if(embedding.offsets.begin(), embedding.offsets.end(),
                                       [&](const Offset& o) { return o.vertex == limb.vertex(ring, j); });
      ASSERT_NE(offset, embedding.offsets.end());
      const Vector3 d = offset->d;
      offset->d = -d;
      rejection(limb, embedding);
      offset->d = 1.01 * d;
      rejection(limb, embedding);
      embedding.offsets.erase(offset);
      rejection(limb, embedding);
    }
  }
  for (const Offset& wrong : {Offset{-1, Vector3::Zero()}, Offset{1 << 30, Vector3::Zero()},
                              Offset{3, Vector3::Constant(std::numeric_limits<double>::quiet_NaN())},
                              Offset{3, Vector3::Constant(std::numeric_limits<double>::infinity())}}) {
    Embedding embedding = limb.embedding;
    embedding.offsets.push_back(wrong);
    EXPECT_THAT(rejection(limb, embedding), Contains("offsets"));
  }
}

TEST(CertificateOfOffsets, PositionsOffTheSphereAreSeenAtTheScaleOfTheirEdges) {
  const Limb limb(1.0 / 10, 32);
  for (const int ring : {14, 20, 30}) {
    SCOPED_TRACE(limb.scale(ring));
    Embedding embedding = limb.embedding;
    const int v = limb.vertex(ring, 1);
    const Exact p = ExactPositions(embedding).exact(v);
    test::store(embedding, v, p * (1 + MostPrecise(limb.scale(ring))), limb.scale(ring));
    EXPECT_THAT(rejection(limb, embedding), Contains("exact_positions"));
  }
}

TEST(CertificateOfOffsets, AFrameThatIsNotCanonicalIsNamed) {
  const Limb limb(1.0 / 8, 40);
  Embedding embedding = limb.embedding;
  const Isometry turn = Space::sphere().rotation(Vector3(1, 2, 3).normalized(), 0.3);
  embedding.positions = turn.on_rows(embedding.positions);
  for (Offset& offset : embedding.offsets) offset.d = turn * offset.d;
  for (Seam& seam : embedding.seams) seam.transform = turn * seam.transform * turn.inverse();
  const Certificate certificate = certify(limb.surface(), embedding);
  EXPECT_FALSE(certificate.bijective);
  for (const Check& check : certificate.checks) {
    if (check.name != "seam_residual") continue;
    EXPECT_THAT(check.detail, HasSubstr("not known exactly"));
  }
}

// Files

TEST(FileOfOffsets, EveryBitComesBack) {
  const Limb limb(1.0 / 8, 40);
  const std::string bytes = serialize_embedding(limb.embedding);
  const Embedding read = parse_embedding(bytes);
  EXPECT_EQ(read.positions, limb.embedding.positions);
  EXPECT_EQ(read.source_vertex, limb.embedding.source_vertex);
  EXPECT_EQ(read.triangles, limb.embedding.triangles);
  std::vector<Offset> sorted = limb.embedding.offsets;
  std::stable_sort(sorted.begin(), sorted.end(),
                   [](const Offset& a, const Offset& b) { return a.vertex < b.vertex; });
  ASSERT_EQ(read.offsets.size(), sorted.size());
  for (std::size_t k = 0; k < sorted.size(); ++k) {
    EXPECT_EQ(read.offsets[k].vertex, sorted[k].vertex);
    EXPECT_EQ(read.offsets[k].d, sorted[k].d);
  }
  Embedding again = read;
  again.target = limb.embedding.target;
  EXPECT_EQ(parse_embedding(serialize_embedding(again)).offsets.size(), read.offsets.size());
  EXPECT_EQ(serialize_embedding(again).size(), bytes.size());
}

TEST(FileOfOffsets, HasNoSuchElementWhereThereAreNone) {
  Limb limb(0.5, 3);
  limb.embedding.offsets.clear();
  EXPECT_EQ(serialize_embedding(limb.embedding).find("offset"), std::string::npos);
  EXPECT_THAT(warnings_of_offsets(limb.embedding), IsEmpty());
}

TEST(FileOfOffsets, WrongOffsetsAreRefusedInOneSentence) {
  const auto refusal = [](const Offset& offset) {
    Limb limb(0.5, 3);
    limb.embedding.offsets = {offset};
    try {
      parse_embedding(serialize_embedding(limb.embedding));
    } catch (const MeshError& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(refusal({3, {1, 2, 3}}), "accepted");
  EXPECT_THAT(refusal({-1, {1, 2, 3}}), HasSubstr("offset 0 names the vertex -1"));
  EXPECT_THAT(refusal({1000, {1, 2, 3}}), HasSubstr("offset 0 names the vertex 1000"));
  EXPECT_THAT(refusal({3, {1, std::numeric_limits<double>::quiet_NaN(), 3}}), HasSubstr("is not finite"));
}

TEST(FileOfOffsets, TheWarningCountsVerticesAndNotOffsets) {
  Limb limb(0.5, 3);
  limb.embedding.offsets = {{3, {1e-20, 0, 0}}, {3, {1e-40, 0, 0}}, {5, {1e-20, 0, 0}}};
  ASSERT_EQ(warnings_of_offsets(limb.embedding).size(), 1u);
  EXPECT_THAT(warnings_of_offsets(limb.embedding)[0], HasSubstr("2 cut vertices, the first 3,"));
}

// Distortion

TEST(DistortionOfOffsets, AreasShrinkByTheSquareOfTheFactorHoweverSmallTheyAre) {
  const Limb limb(1.0 / 8, 60);  // areas to 1e-108
  const std::vector<FaceDistortion> of_face = measure_triangles(limb.surface(), limb.embedding);
  for (int ring = 12; ring < 59; ++ring) {
    for (int k = 0; k < 8; ++k) {
      const FaceDistortion &here = of_face[limb.first_face(ring) + k],
                           &next = of_face[limb.first_face(ring + 1) + k];
      EXPECT_NEAR(next.area / here.area * 64, 1, 1e-9) << ring;
      EXPECT_NEAR(next.angle / here.angle, 1, 1e-9) << ring;
    }
  }
  const Distortion distortion = measure_distortion(limb.surface(), limb.embedding);
  EXPECT_EQ(distortion.measured_faces, limb.mesh.F.rows());
  EXPECT_GT(distortion.area.max, 1e100);
  EXPECT_TRUE(std::isfinite(distortion.sigma));
}

TEST(DistortionOfOffsets, TheScaleOfALimbIsRightToThreeDigits) {
  // sigma is the deviation of 1/2 log A: here that of an arithmetic sequence with the step log 8, but for the
  // first rings.
  const Limb limb(1.0 / 8, 60);
  const Distortion distortion = measure_distortion(limb.surface(), limb.embedding);
  EXPECT_NEAR(distortion.sigma / (std::log(8.0) * 60 / std::sqrt(12.0)), 1, 0.05);
}

}  // namespace
}  // namespace orbitutte::offsets_test
