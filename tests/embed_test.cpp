// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <numbers>

#include "hand_made.h"
#include "orbitutte/report/embedding_file.h"
#include "random_spheres.h"
#include "sample_embeddings.h"

namespace orbitutte::embed_test {
namespace {

using std::numbers::pi;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// With the paper's weights.
EmbedOptions one_thread() {
  EmbedOptions options;
  options.weights.kind = WeightKind::cotan;
  options.threads = 1;
  return options;
}

EmbedResult embedded(const Mesh& mesh, const std::string& signature, const std::vector<int>& marks,
                     const EmbedOptions& options = one_thread()) {
  return embed(mesh, parse_orbifold(signature), marks, options);
}

std::string failures(const EmbedResult& result) {
  std::string text = name_of(result.minimum.termination);
  for (const Check& check : result.certificate.checks)
    if (!check.passed) text += "; " + check.name + ": " + check.detail;
  return text;
}

void expect_certified(const EmbedResult& result, const std::string& what) {
  EXPECT_EQ(result.minimum.termination, Termination::converged) << what;
  EXPECT_TRUE(result.certificate.bijective) << what << ": " << failures(result);
}

double difference(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  return (a - b).cwiseAbs().maxCoeff();
}

// The sentence with which a mesh is refused.
std::string refusal_to_embed(const Mesh& mesh, const std::string& signature, const std::vector<int>& marks) {
  try {
    embedded(mesh, signature, marks);
  } catch (const MeshError& error) {
    return error.what();
  }
  return "accepted";
}

// Families

TEST(Embed, EveryFamilyIsConvergedAndCertified) {
  for (const std::string& signature : test::sample_signatures()) {
    const EmbedResult& result = test::sample_embedding(signature).result;
    expect_certified(result, signature);
    EXPECT_EQ(result.embedding.target.signature, signature);
    EXPECT_EQ(result.minimum.history.size(), static_cast<std::size_t>(result.minimum.iterations) + 1);
    EXPECT_GE(result.minimum.evaluations, result.minimum.iterations);
  }
}

TEST(Embed, StandardWeightsAreThoseOfTheDelaunayTriangulation) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    EmbedOptions named;
    named.weights.kind = WeightKind::delaunay;
    const EmbedResult standard = embedded(sample.mesh, signature, sample.marks, {}),
                      delaunay = embedded(sample.mesh, signature, sample.marks, named);
    expect_certified(standard, signature);
    EXPECT_EQ(standard.weights.kind, WeightKind::delaunay);
    EXPECT_EQ(standard.embedding.positions, delaunay.embedding.positions) << signature;
  }
}

TEST(Embed, EnergyFallsToTheMinimum) {
  for (const std::string& signature : test::sample_signatures()) {
    const Minimum& minimum = test::sample_embedding(signature).result.minimum;
    for (std::size_t k = 1; k < minimum.history.size(); ++k)
      EXPECT_LE(minimum.history[k].energy, minimum.history[k - 1].energy * (1 + 1e-12)) << signature;
    EXPECT_NEAR(minimum.history.back().energy, minimum.energy, 1e-12 * minimum.energy);
    EXPECT_LT(minimum.gradient_norm, 1e-8);
  }
}

TEST(Embed, EnergyApproachesTwiceTheAreaUnderRefinement) {
  // A sphere that is the orbifold's own: a conformal map is the identity's quotient, so nothing is lost but
  // the discretisation. The poles of 22 and the mirrors of *22 fit an octasphere.
  double before = 1e9;
  for (const int levels : {2, 3, 4}) {
    const EmbedResult result = embedded(test::octasphere(levels), "22", {4, 5});
    expect_certified(result, "22");
    const double excess = result.minimum.energy / (2 * 4 * pi / 2) - 1;
    EXPECT_GT(excess, 0) << levels;
    EXPECT_LT(excess, 0.8 * before) << levels;
    before = excess;
  }
  EXPECT_LT(before, 0.1);
}

TEST(Embed, MarksSitAtConesOfTheRightOrder) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Target orbifold = parse_orbifold(signature);
    ASSERT_EQ(sample.embedding().cones.size(), sample.marks.size());
    for (std::size_t k = 0; k < sample.marks.size(); ++k) {
      const ConeCopies& cone = sample.embedding().cones[k];
      EXPECT_EQ(cone.vertex, sample.marks[k]);
      EXPECT_EQ(cone.mark.order(), orbifold.marks[k].order());
    }
  }
}

TEST(Embed, AdjacentConesAreEmbedded) {
  const Mesh mesh = test::perturbed(test::icosphere(2), 0.02, 3);
  const int a = mesh.F(10, 0), b = mesh.F(10, 1);
  for (const char* signature : {"532", "332", "225"}) {
    expect_certified(embedded(mesh, signature, {a, b, 100}), signature);
    expect_certified(embedded(mesh, signature, {100, a, b}), signature);
    expect_certified(embedded(mesh, signature, {a, 100, b}), signature);
  }
}

// The cones of NN and the corners of *NN lie opposite to each other: an edge between them has no image.
TEST(Embed, OppositeMarksThatAnEdgeJoinsAreRefused) {
  const Mesh sphere = test::perturbed(test::icosphere(2), 0.02, 3);
  const int a = sphere.F(10, 0), b = sphere.F(10, 1);
  const auto names_both = [](int v, int w) {
    return AllOf(HasSubstr(std::to_string(v)), HasSubstr(std::to_string(w)));
  };
  for (const char* signature : {"22", "33", "12,12"}) {
    EXPECT_THAT(refusal_to_embed(sphere, signature, {a, b}), names_both(a, b)) << signature;
    EXPECT_THAT(refusal_to_embed(test::tetrahedron(), signature, {0, 2}), names_both(0, 2)) << signature;
  }
  const Mesh disk = test::round_disk(5), grid = test::grid_disk(5, 5);
  for (const char* signature : {"*22", "*33", "*12,12"}) {
    EXPECT_THAT(refusal_to_embed(disk, signature, {70, 71}), names_both(70, 71))
        << signature;  // on the boundary
    EXPECT_THAT(refusal_to_embed(grid, signature, {4, 11}), names_both(4, 11))
        << signature;  // across the inside
  }
}

TEST(Embed, ThreeConesOnOneFaceAreEmbedded) {
  const Mesh mesh = test::perturbed(test::icosphere(2), 0.02, 3);
  for (const int face : {0, 57, 200})
    for (const char* signature : {"532", "432", "332", "222", "223"})
      expect_certified(embedded(mesh, signature, {mesh.F(face, 0), mesh.F(face, 2), mesh.F(face, 1)}),
                       signature);
}

// A vertex of degree three in the middle of the face.
Mesh with_apex(Mesh mesh, int face) {
  const int apex = test::vertex_count(mesh), a = mesh.F(face, 0), b = mesh.F(face, 1), c = mesh.F(face, 2);
  mesh.V.conservativeResize(apex + 1, 3);
  mesh.V.row(apex) = (mesh.V.row(a) + mesh.V.row(b) + mesh.V.row(c)).eval() / 2.8;
  mesh.F.row(face) << a, b, apex;
  return test::with_face(test::with_face(mesh, b, c, apex), c, a, apex);
}

TEST(Embed, ConesOfDegreeThreeAreEmbedded) {
  Mesh mesh = test::perturbed(test::icosphere(2), 0.02, 5);
  const int first = test::vertex_count(mesh);
  for (const int face : {3, 150, 290}) mesh = with_apex(mesh, face);
  for (const char* signature : {"532", "332", "222", "2,2,12"})
    expect_certified(embedded(mesh, signature, {first, first + 1, first + 2}), signature);
  for (const char* signature : {"22", "55"})
    expect_certified(embedded(mesh, signature, {first, first + 2}), signature);
  const int neighbour = mesh.F(3, 0);
  expect_certified(embedded(mesh, "532", {first, neighbour, first + 1}), "an apex and its neighbour");
}

TEST(Embed, SmallestMeshesAreEmbedded) {
  for (const char* signature : {"532", "432", "332", "222", "223"}) {
    expect_certified(embedded(test::tetrahedron(), signature, {0, 1, 2}), signature);
    expect_certified(embedded(test::octahedron(), signature, {0, 2, 4}), signature);
    expect_certified(embedded(test::icosahedron(), signature, {0, 5, 11}), signature);
  }
  for (const char* signature : {"33", "55"})
    expect_certified(embedded(test::icosahedron(), signature, {0, 11}), signature);
  expect_certified(embedded(test::mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}}), "*532", {0, 1, 2}),
                   "a triangle");
}

TEST(Embed, CornersAtEveryPairOfAGridAreEmbedded) {
  // Marked at the corners with a single triangle, which would be arcs elsewhere.
  const Mesh mesh = test::grid_disk(9, 7);
  const int east = 9, north = 8 * 10 - 1;
  for (const char* signature : {"*22", "*55"})
    expect_certified(embedded(mesh, signature, {east, north - 9}), signature);
  for (const char* signature : {"*532", "*222", "*2,2,12"})
    expect_certified(embedded(mesh, signature, {east, north - 9, 0}), signature);
}

TEST(Embed, CornersMayBeGivenInEitherDirection) {
  const Mesh mesh = test::sample_mesh_for(parse_orbifold("*532"));
  for (const char* signature : {"*532", "*432", "*332", "*225"}) {
    expect_certified(embedded(mesh, signature, {170, 185, 200}), signature);
    expect_certified(embedded(mesh, signature, {200, 185, 170}), signature);
  }
}

// A cone inside a disk

TEST(Embed, ConeNextToTheBoundaryIsEmbedded) {
  const Mesh mesh = test::sample_mesh_for(parse_orbifold("3*2"));
  const std::vector<std::array<int, 2>> edges = connectivity_of(mesh.F, test::vertex_count(mesh)).edges;
  int found = 0;
  for (std::size_t e = 0; e < edges.size() && found < 3; e += 7) {
    const auto [inner, outer] = edges[e];
    if (inner >= 169 || outer < 169) continue;
    ++found;
    for (const char* signature : {"3*2", "2*2", "2*7"})
      expect_certified(embedded(mesh, signature, {inner, outer}), signature);
    for (const char* signature : {"2*", "7*"})
      expect_certified(embedded(mesh, signature, {inner}), signature);
  }
  EXPECT_EQ(found, 3);
}

TEST(Embed, SmallestDiskWithAVertexInsideIsEmbedded) {
  const Mesh mesh =
      test::mesh({{1, 0, 0}, {-1, 1, 0}, {-1, -1, 0}, {0, 0, 0}}, {{0, 1, 3}, {1, 2, 3}, {2, 0, 3}});
  for (const char* signature : {"3*2", "2*2", "2*3", "2*5", "2*12"})
    expect_certified(embedded(mesh, signature, {3, 1}), signature);
  for (const char* signature : {"2*", "3*", "5*", "12*"})
    expect_certified(embedded(mesh, signature, {3}), signature);
}

RC_GTEST_PROP(Embed, AnyConeInsideAndAnyCornerAreEmbedded, (std::uint32_t seed)) {
  const Mesh& mesh =
      test::sample_embedding("3*2").mesh;  // every vertex of its boundary has two faces or more
  const int cone = static_cast<int>(seed % 169), corner = 169 + static_cast<int>(seed / 169 % 48);
  const std::vector<std::string> signatures = {"3*2", "2*2", "2*3", "2*5", "2*8", "2*", "3*", "5*", "8*"};
  const std::string& signature = signatures[seed / 8112 % signatures.size()];
  const Target orbifold = parse_orbifold(signature);
  std::vector<int> marks = {cone, corner};
  marks.resize(orbifold.marks.size());
  EmbedOptions options = one_thread();
  options.cut.seed = seed % 5;
  const EmbedResult result = embed(mesh, orbifold, marks, options);
  RC_ASSERT(result.minimum.termination == Termination::converged);
  RC_ASSERT(result.certificate.bijective);
}

TEST(Embed, CornerWithASingleFaceIsEmbedded) {
  const Mesh mesh = test::grid_disk(6, 6);  // corners 6 and 42 have a single face
  for (const char* signature : {"3*2", "2*2", "2*5"}) {
    const EmbedResult result = embedded(mesh, signature, {24, 6});
    expect_certified(result, signature);
    ASSERT_EQ(result.warnings.size(), 1u);  // of the other one
    EXPECT_THAT(result.warnings[0], HasSubstr("1 face must become arcs"));
  }
}

TEST(Embed, DiskWithoutVerticesInsideHasNoConeToChoose) {
  try {
    choose_cones(test::grid_disk(5, 1), parse_orbifold("3*2"));
    FAIL();
  } catch (const MeshError& error) {
    EXPECT_STREQ(error.what(), "one vertex has to be marked inside the surface, but all are on its boundary");
  }
}

// Invariance

TEST(Embed, TheCutChangesNothing) {
  for (const char* signature : {"532", "332", "222", "225", "22", "33", "12,12", "3*2", "2*2", "2*5", "2*",
                                "5*", "12*", "1x", "2x", "5x"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Eigen::VectorXd before = test::edge_lengths(sample.mesh, sample.embedding());
    for (const std::uint64_t seed : {1, 2, 3}) {
      EmbedOptions options = one_thread();
      options.cut.seed = seed;
      const EmbedResult other = embedded(sample.mesh, signature, sample.marks, options);
      expect_certified(other, signature);
      EXPECT_LT(difference(test::edge_lengths(sample.mesh, other.embedding), before), 1e-8)
          << signature << " " << seed;
      EXPECT_NEAR(other.minimum.energy, sample.result.minimum.energy, 1e-10 * other.minimum.energy);
    }
  }
}

TEST(Embed, MovingAndScalingTheMeshChangesNothing) {
  for (const char* signature : {"532", "22", "*432", "*22", "3*2", "5*", "1x", "3x"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const Eigen::VectorXd before = test::edge_lengths(sample.mesh, sample.embedding());
    for (const double scale : {1e-100, 1e-3, 1.0, 1e5, 1e100}) {
      Mesh mesh = sample.mesh;
      mesh.V = scale * (mesh.V * hand_made::rotation({1, 2, 3}, 1)).eval();
      mesh.V.rowwise() += scale * Eigen::RowVector3d(1, -2, 3);
      const EmbedResult moved = embedded(mesh, signature, sample.marks);
      expect_certified(moved, signature);
      EXPECT_LT(difference(test::edge_lengths(mesh, moved.embedding), before), 1e-8)
          << signature << " " << scale;
    }
  }
}

TEST(Embed, RenumberingVerticesAndFacesChangesNothing) {
  for (const char* signature : {"532", "22", "*432", "*22", "3*2", "5*", "1x", "3x"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const std::vector<int> new_number = test::permutation(test::vertex_count(sample.mesh), 17);
    const std::vector<int> old_face = test::permutation(test::face_count(sample.mesh), 18);
    const Mesh mesh = test::reordered(test::relabelled(sample.mesh, new_number), old_face);
    std::vector<int> marks;
    for (const int v : sample.marks) marks.push_back(new_number[v]);
    const EmbedResult other = embedded(mesh, signature, marks);
    expect_certified(other, signature);
    const auto length = [](const Embedding& e, int f, int k) {
      return Space::sphere().distance(e.positions.row(e.triangles(f, k)),
                                      e.positions.row(e.triangles(f, (k + 1) % 3)));
    };
    double worst = 0;
    for (int f = 0; f < test::face_count(mesh); ++f)
      for (int k = 0; k < 3; ++k)
        worst = std::max(
            worst, std::abs(length(other.embedding, f, k) - length(sample.embedding(), old_face[f], k)));
    EXPECT_LT(worst, 1e-8) << signature;
  }
}

TEST(Embed, PermutingConesTogetherWithTheirOrdersChangesNothing) {
  for (const std::string star : {"", "*"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(star + "532");
    const Eigen::VectorXd before = test::edge_lengths(sample.mesh, sample.embedding());
    std::vector<int> order = {0, 1, 2};
    do {
      std::string signature = star;
      std::vector<int> marks;
      for (const int k : order) {
        signature += "532"[k];
        marks.push_back(sample.marks[k]);
      }
      const EmbedResult other = embedded(sample.mesh, signature, marks);
      expect_certified(other, signature);
      EXPECT_EQ(other.embedding.target.signature, signature);
      EXPECT_LT(difference(test::edge_lengths(sample.mesh, other.embedding), before), 1e-8) << signature;
    } while (std::next_permutation(order.begin(), order.end()));
  }
}

TEST(Embed, ScalingTheWeightsChangesNoPosition) {
  // The uniform weight, at two clamps that it ignores.
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  EmbedOptions a = one_thread(), b = one_thread();
  a.weights.kind = b.weights.kind = WeightKind::uniform;
  b.weights.clamp = 0.5;
  EXPECT_EQ(embedded(sample.mesh, "532", sample.marks, a).embedding.positions,
            embedded(sample.mesh, "532", sample.marks, b).embedding.positions);
}

TEST(Embed, TwoRunsAndAnyNumberOfThreadsGiveTheSameBytes) {
  for (const char* signature : {"532", "22", "*432", "2*3", "5*"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const std::string before = serialize_embedding(sample.embedding());
    for (const int threads : {1, 2}) {
      EmbedOptions options = one_thread();
      options.threads = threads;
      const EmbedResult again = embedded(sample.mesh, signature, sample.marks, options);
      EXPECT_EQ(serialize_embedding(again.embedding), before) << signature << ", threads: " << threads;
      EXPECT_EQ(again.minimum.energy, sample.result.minimum.energy);
      EXPECT_EQ(again.threads, threads);
    }
  }
}

TEST(Embed, BackendsAgree) {
  for (const char* signature : {"532", "22", "*432", "*22", "3*2", "2*"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    for (const Backend backend : available_backends()) {
      EmbedOptions options = one_thread();
      options.laplacian.backend = backend;
      const EmbedResult other = embedded(sample.mesh, signature, sample.marks, options);
      expect_certified(other, signature);
      EXPECT_EQ(other.backend, backend);
      EXPECT_LT((other.embedding.positions - sample.embedding().positions).cwiseAbs().maxCoeff(), 1e-9)
          << signature << " " << name_of(backend);
    }
  }
}

// Progress

TEST(Embed, ProgressTellsTheStagesInOrder) {
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  std::vector<std::string> stages;
  int last_iteration = 0;
  EmbedOptions options = one_thread();
  options.progress = [&](const Progress& progress) {
    if (stages.empty() || stages.back() != progress.stage) stages.push_back(progress.stage);
    if (progress.stage == "optimize") {
      EXPECT_GE(progress.iteration, last_iteration);
      last_iteration = progress.iteration;
    }
    return true;
  };
  const EmbedResult result = embedded(sample.mesh, "532", sample.marks, options);
  EXPECT_THAT(stages,
              ElementsAre("validate", "weights", "cut", "factorize", "initialize", "optimize", "certify"));
  EXPECT_EQ(last_iteration, result.minimum.iterations);
  std::vector<std::string> timed;
  for (const auto& [stage, seconds] : result.timings) {
    timed.push_back(stage);
    EXPECT_GE(seconds, 0);
  }
  EXPECT_EQ(timed, stages);
}

TEST(Embed, ProgressCanCancelAtEveryStage) {
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  for (const std::string stage :
       {"validate", "weights", "cut", "factorize", "initialize", "optimize", "certify"}) {
    EmbedOptions options = one_thread();
    options.progress = [&](const Progress& progress) { return progress.stage != stage; };
    EXPECT_THROW(embedded(sample.mesh, "532", sample.marks, options), Cancelled) << stage;
  }
  EmbedOptions options = one_thread();
  options.progress = [](const Progress& progress) { return progress.iteration < 3; };
  EXPECT_THROW(embedded(sample.mesh, "532", sample.marks, options), Cancelled);
}

TEST(Embed, TooFewIterationsAreNeverBijective) {
  for (const char* signature : {"532", "*22"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    EmbedOptions options = one_thread();
    options.max_iterations = 1;
    const EmbedResult result = embedded(sample.mesh, signature, sample.marks, options);
    EXPECT_EQ(result.minimum.termination, Termination::max_iterations);
    EXPECT_EQ(result.minimum.iterations, 1);
    EXPECT_FALSE(result.certificate.bijective);
    EXPECT_FALSE(std::all_of(result.certificate.checks.begin(), result.certificate.checks.end(),
                             [](const Check& check) { return check.passed; }));
  }
}

TEST(Embed, TheMarkOfOneCrossChangesNothing) {
  const Mesh mesh = test::projective_plane(3);
  const Eigen::VectorXd before = test::edge_lengths(mesh, embedded(mesh, "1x", {0}).embedding);
  for (const int v : {1, 5, 40, 200})
    EXPECT_LT(difference(test::edge_lengths(mesh, embedded(mesh, "1x", {v}).embedding), before), 1e-7) << v;
}

RC_GTEST_PROP(Embed, AnyConeOfAnyProjectivePlaneIsEmbedded, (std::uint32_t seed)) {
  const Mesh mesh = test::random_projective_plane(seed, static_cast<int>(seed % 20));
  const int v = static_cast<int>(seed % mesh.V.rows());
  for (const char* signature : {"1x", "2x", "5x"}) {
    EmbedOptions options = one_thread();
    options.weights.kind = WeightKind::uniform;
    const EmbedResult result = embedded(mesh, signature, {v}, options);
    RC_ASSERT(result.minimum.termination == Termination::converged);
    RC_ASSERT(result.certificate.bijective);
  }
}

// Defects

TEST(Embed, WrongTopologyIsNamed) {
  const Mesh sphere = test::icosphere(1), disk = test::round_disk(3);
  EXPECT_THAT(refusal_to_embed(disk, "532", {20, 25, 30}),
              AllOf(HasSubstr("disk"), HasSubstr("532"), HasSubstr("sphere")));
  EXPECT_THAT(refusal_to_embed(sphere, "*22", {0, 1}),
              AllOf(HasSubstr("sphere"), HasSubstr("*22"), HasSubstr("disk")));
  EXPECT_THAT(refusal_to_embed(test::projective_plane(1), "532", {0, 1, 2}),
              AllOf(HasSubstr("projective plane"), HasSubstr("532"), HasSubstr("sphere")));
  EXPECT_THAT(refusal_to_embed(sphere, "3x", {0}),
              AllOf(HasSubstr("sphere"), HasSubstr("3x"), HasSubstr("projective plane")));
  for (const Mesh& mesh :
       {test::torus(5, 5), test::annulus(6), test::moebius_strip(6), test::klein_bottle(5, 5),
        test::united(sphere, sphere), test::with_vertices_merged(sphere, 0, 11)}) {
    const std::string sentence = refusal_to_embed(mesh, "532", {1, 2, 3});
    EXPECT_NE(sentence, "accepted");
    EXPECT_GT(sentence.size(), 20u);
  }
}

TEST(Embed, DefectiveMeshesAreRefused) {
  const Mesh sphere = test::icosphere(1);
  EXPECT_NE(refusal_to_embed(Mesh(), "532", {0, 1, 2}), "accepted");
  Mesh broken = sphere;
  broken.V(5, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(refusal_to_embed(broken, "532", {0, 1, 2}), HasSubstr("5"));
  broken = sphere;
  broken.F(7, 0) = 1000;
  EXPECT_THAT(refusal_to_embed(broken, "532", {0, 1, 2}), AllOf(HasSubstr("7"), HasSubstr("1000")));
  broken.F(7, 0) = -3;
  EXPECT_THAT(refusal_to_embed(broken, "532", {0, 1, 2}), HasSubstr("-3"));
  EXPECT_NE(refusal_to_embed(test::with_face_turned(sphere, 4), "532", {0, 1, 2}), "accepted");
}

TEST(Embed, WrongMarksAreNamed) {
  const Mesh sphere = test::icosphere(1), disk = test::round_disk(3);
  EXPECT_THAT(refusal_to_embed(sphere, "532", {0, 1}),
              AllOf(HasSubstr("532"), HasSubstr("3"), HasSubstr("2")));
  EXPECT_THAT(refusal_to_embed(sphere, "532", {}), HasSubstr("not 0"));
  EXPECT_THAT(refusal_to_embed(sphere, "33", {0, 1, 2}), HasSubstr("not 3"));
  EXPECT_THAT(refusal_to_embed(sphere, "532", {0, 1, 42}),
              AllOf(HasSubstr("42"), HasSubstr("out of range"), HasSubstr("41")));
  EXPECT_THAT(refusal_to_embed(sphere, "532", {0, -1, 2}), AllOf(HasSubstr("-1"), HasSubstr("out of range")));
  EXPECT_THAT(refusal_to_embed(sphere, "532", {0, 5, 5}), AllOf(HasSubstr("5"), HasSubstr("twice")));
  EXPECT_THAT(refusal_to_embed(disk, "*532", {20, 0, 30}),
              AllOf(HasSubstr("0"), HasSubstr("inside the disk")));
  EXPECT_THAT(refusal_to_embed(disk, "*22", {36, 37}), HasSubstr("out of range"));
  const std::string outside = " is on the boundary of the disk; mark a vertex inside";
  EXPECT_EQ(refusal_to_embed(disk, "3*2", {20, 0}), "the marked vertex 20" + outside);
  EXPECT_EQ(refusal_to_embed(disk, "5*", {30}), "the marked vertex 30" + outside);
  EXPECT_EQ(refusal_to_embed(disk, "2*3", {0, 1}),
            "the marked vertex 1 is inside the disk; mark a vertex on its boundary");
  EXPECT_THAT(refusal_to_embed(disk, "5*", {0, 20}), AllOf(HasSubstr("5*"), HasSubstr("not 2")));
  EXPECT_THAT(refusal_to_embed(disk, "3*2", {0, 37}), HasSubstr("out of range"));
  Mesh spare = sphere;
  spare.V.conservativeResize(43, 3);
  spare.V.row(42).setZero();
  EXPECT_THAT(refusal_to_embed(spare, "532", {0, 1, 42}), AllOf(HasSubstr("42"), HasSubstr("no face")));
}

TEST(Embed, OptionsOutOfRangeAreRefused) {
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  const auto refused = [&](auto change) {
    EmbedOptions options = one_thread();
    change(options);
    EXPECT_THROW(embedded(sample.mesh, "532", sample.marks, options), ArgumentError);
  };
  refused([](EmbedOptions& o) { o.threads = -1; });
  refused([](EmbedOptions& o) { o.tolerance = -1; });
  refused([](EmbedOptions& o) { o.tolerance = std::numeric_limits<double>::quiet_NaN(); });
  refused([](EmbedOptions& o) { o.max_iterations = -1; });
  refused([](EmbedOptions& o) { o.weights.clamp = 0; });
  refused([](EmbedOptions& o) { o.weights.clamp = std::numeric_limits<double>::infinity(); });
}

// Odd meshes

TEST(Embed, UnreferencedVerticesKeepTheirIndexAtTheNorthPole) {
  for (const char* signature : {"532", "22", "*432", "3*2", "5*"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const int n = test::vertex_count(sample.mesh);
    Mesh mesh = sample.mesh;  // one in front, one in the middle, one behind
    mesh.V.resize(n + 3, 3);
    mesh.V << Eigen::RowVector3d(9, 9, 9), sample.mesh.V.topRows(50), Eigen::RowVector3d(1, 0, 0),
        sample.mesh.V.bottomRows(n - 50), Eigen::RowVector3d(0, 0, 0);
    const auto moved = [](int v) { return v < 50 ? v + 1 : v + 2; };
    mesh.F = mesh.F.unaryExpr(moved);
    std::vector<int> marks;
    for (const int v : sample.marks) marks.push_back(moved(v));
    const EmbedResult result = embedded(mesh, signature, marks);
    expect_certified(result, signature);
    EXPECT_EQ(result.unreferenced_vertices, 3);
    for (const int v : {0, 51, n + 2}) {
      EXPECT_EQ(result.embedding.positions.row(v), Eigen::RowVector3d(0, 0, 1)) << signature << " " << v;
      EXPECT_EQ(result.embedding.source_vertex[v], v);
    }
    double worst = 0;
    for (int v = 0; v < n; ++v)
      worst = std::max(worst, (result.embedding.positions.row(moved(v)) - sample.embedding().positions.row(v))
                                  .cwiseAbs()
                                  .maxCoeff());
    EXPECT_LT(worst, 1e-8) << signature;
  }
}

// A vertex in the middle of the opposite edge, up to rounding, and then on top of its neighbour.
TEST(Embed, FacesWithoutAreaSurvive) {
  for (const char* signature : {"532", "22", "*432", "2*3", "3*"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    for (const int face : {0, 5, 20, 40, 60, 80}) {
      Mesh mesh = sample.mesh;
      const int a = mesh.F(face, 0), b = mesh.F(face, 1), c = mesh.F(face, 2);
      const std::string what = std::string(signature) + ", face " + std::to_string(face);
      mesh.V.row(a) = (mesh.V.row(b) + mesh.V.row(c)).eval() / 2;
      const EmbedResult result = embedded(mesh, signature, sample.marks);
      expect_certified(result, what);
      EXPECT_GE(result.zero_area_faces, 1) << what;
      EXPECT_LT(result.weights.w.maxCoeff(), 1e6) << what;
      mesh.V.row(a) = mesh.V.row(b).eval();
      const EmbedResult collapsed = embedded(mesh, signature, sample.marks);
      expect_certified(collapsed, what);
      EXPECT_GE(collapsed.zero_area_faces, 2) << what;
      EXPECT_EQ(collapsed.distortion.measured_faces, test::face_count(mesh) - collapsed.zero_area_faces)
          << what;
    }
  }
}

TEST(Embed, ChosenMarksAreDifferentAndWhereTheyHaveToBe) {
  for (const std::string& signature : test::sample_signatures()) {
    const Target orbifold = parse_orbifold(signature);
    std::vector<int> marks = test::sample_embedding(signature).marks;
    EXPECT_EQ(marks.size(), orbifold.marks.size());
    if (orbifold.topology == Topology::disk) {
      for (int k = 0; k < static_cast<int>(marks.size()); ++k)
        EXPECT_EQ(marks[k] < 169, k < orbifold.inner_marks) << signature;  // 169 begins the last ring
    }
    std::sort(marks.begin(), marks.end());
    EXPECT_EQ(std::adjacent_find(marks.begin(), marks.end()), marks.end());
  }
  EXPECT_THROW(choose_cones(test::round_disk(2), parse_orbifold("532")), MeshError);
}

// --- many embeddings of one mesh, any number of threads

bool same(const EmbedResult& a, const EmbedResult& b) {
  return a.embedding.positions == b.embedding.positions && a.embedding.triangles == b.embedding.triangles &&
         a.minimum.energy == b.minimum.energy && a.certificate.bijective == b.certificate.bijective &&
         a.distortion.area.mean == b.distortion.area.mean &&
         a.distortion.angle.mean == b.distortion.angle.mean;
}

TEST(EmbeddingSolver, GivesWhatSeparateEmbeddingsGive) {
  const Mesh sphere = test::perturbed(test::icosphere(4), 0.02, 5);
  EmbedOptions options;
  options.laplacian.block_size = 300;  // several blocks, some of which the cuts below do not meet
  EmbeddingSolver solver(sphere, options);
  const std::vector<int> marks = choose_cones(sphere, parse_orbifold("432"));
  const std::vector<int> others = {marks[0], marks[1], sphere.F(700, 0)};
  for (const auto& [signature, cones] :
       {std::pair("432", marks), std::pair("532", marks), std::pair("432", others), std::pair("222", others),
        std::pair("432", marks)})
    EXPECT_TRUE(same(solver.embed(parse_orbifold(signature), cones),
                     embed(sphere, parse_orbifold(signature), cones, options)))
        << signature;
}

// So many vertices that those around the cones are put on the banks.
TEST(EmbeddingSolver, GivesWhatSeparateEmbeddingsGiveWhereItKeepsTheWholeFactor) {
  const Mesh sphere = test::perturbed(test::icosphere(6), 0.005, 5);
  const std::vector<int> marks = choose_cones(sphere, parse_orbifold("432"));
  EmbeddingSolver solver(sphere);
  for (const std::string signature : {"432", "532", "222"})
    EXPECT_TRUE(
        same(solver.embed(parse_orbifold(signature), marks), embed(sphere, parse_orbifold(signature), marks)))
        << signature;
}

TEST(EmbeddingSolver, GivesWhatSeparateEmbeddingsOfADiskGive) {
  const Mesh disk = test::perturbed(test::round_disk(20), 0.01, 5);
  EmbedOptions options;
  options.laplacian.block_size = 300;
  EmbeddingSolver solver(disk, options);
  const std::vector<int> around = choose_cones(disk, parse_orbifold("*432"));
  const std::vector<int> cones = choose_cones(disk, parse_orbifold("3*2"));
  for (const auto& [signature, marks] :
       {std::pair("3*2", cones), std::pair("*432", around), std::pair("2*5", cones),
        std::pair("5*", std::vector<int>{cones[0]}), std::pair("3*2", cones)})
    EXPECT_TRUE(same(solver.embed(parse_orbifold(signature), marks),
                     embed(disk, parse_orbifold(signature), marks, options)))
        << signature;
}

TEST(EmbeddingSolver, ChecksTheSameMarksForEveryOrbifold) {
  EmbeddingSolver solver(test::round_disk(8));
  const std::vector<int> inside_and_outside = choose_cones(test::round_disk(8), parse_orbifold("2*3"));
  EXPECT_TRUE(solver.embed(parse_orbifold("2*3"), inside_and_outside).certificate.bijective);
  EXPECT_THROW(solver.embed(parse_orbifold("*33"), inside_and_outside), MeshError);
  EXPECT_TRUE(solver.embed(parse_orbifold("3*2"), inside_and_outside).certificate.bijective);
}

TEST(EmbeddingSolver, TellsOfADefectAtOnce) { EXPECT_THROW(EmbeddingSolver(test::torus(8, 6)), MeshError); }

TEST(Embed, DoesNotDependOnTheNumberOfThreads) {
  for (const std::string signature : {"432", "22", "*532", "3*2", "5*"}) {
    const Target orbifold = parse_orbifold(signature);
    const Mesh mesh = orbifold.topology == Topology::sphere ? test::perturbed(test::icosphere(5), 0.01, 6)
                                                            : test::perturbed(test::round_disk(50), 0.01, 6);
    const std::vector<int> marks = choose_cones(mesh, orbifold);
    EmbedOptions options;
    options.laplacian.block_size = 2000;
    options.threads = 1;
    const EmbedResult one = embed(mesh, orbifold, marks, options);
    for (const int threads : {2, 3}) {
      options.threads = threads;
      EXPECT_TRUE(same(one, embed(mesh, orbifold, marks, options))) << signature << ' ' << threads;
    }
  }
}

}  // namespace
}  // namespace orbitutte::embed_test
