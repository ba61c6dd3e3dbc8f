// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <numbers>

#include "hand_made.h"
#include "sample_embeddings.h"

namespace orbitutte::energy_test {
namespace {

using std::numbers::pi;

double energy(const test::SampleEmbedding& sample, const Embedding& embedding) {
  return dirichlet_energy(test::unjudged(sample.mesh), sample.result.weights, embedding);
}

TEST(Energy, IsTheOneThatTheOptimiserReports) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    const double reported = sample.result.minimum.energy;
    EXPECT_NEAR(energy(sample, sample.embedding()), reported, 1e-12 * reported) << signature;
  }
}

TEST(Energy, IsTheOneThatTheOptimiserReportsWithUniformWeights) {
  EmbedOptions options;
  options.threads = 1;
  options.weights.kind = WeightKind::uniform;
  for (const char* signature : {"532", "22", "*432", "*22"}) {
    const test::SampleEmbedding sample = test::make_sample(signature, options);
    const double reported = sample.result.minimum.energy;
    EXPECT_NEAR(energy(sample, sample.embedding()), reported, 1e-12 * reported) << signature;
  }
}

TEST(Energy, OfRegularSolidsIsKnown) {
  // Every edge of the octahedron is a quarter of a great circle.
  const Mesh octahedron = test::octahedron();
  const Surface surface = make_surface(octahedron);
  Embedding embedding;  // into the sphere, cut nowhere
  embedding.positions = octahedron.V;
  embedding.triangles = octahedron.F;
  embedding.source_vertex = {0, 1, 2, 3, 4, 5};
  WeightOptions uniform;
  uniform.kind = WeightKind::uniform;
  EdgeWeights weights = edge_weights(surface, uniform);
  EXPECT_NEAR(dirichlet_energy(surface, weights, embedding), 12 * pi * pi / 4, 1e-12);
  weights.w *= 3;
  EXPECT_NEAR(dirichlet_energy(surface, weights, embedding), 36 * pi * pi / 4, 1e-12);
}

TEST(Energy, CountsEveryEdgeOnce) {
  const test::SampleEmbedding& sample = test::sample_embedding("532");
  const Eigen::VectorXd lengths = test::edge_lengths(sample.mesh, sample.embedding());
  const double expected = sample.result.weights.w.dot(lengths.cwiseAbs2());
  EXPECT_NEAR(energy(sample, sample.embedding()), expected, 1e-12 * expected);
}

TEST(Energy, RotatingAndMirroringTheSphereChangesNothing) {
  const test::SampleEmbedding& sample = test::sample_embedding("*432");
  for (const Matrix3& M : {hand_made::rotation({3, 1, 2}, 0.8), hand_made::reflection({1, 2, 3})}) {
    Embedding moved = sample.embedding();
    moved.positions = moved.positions * M.transpose();
    EXPECT_NEAR(energy(sample, moved), sample.result.minimum.energy, 1e-12 * sample.result.minimum.energy);
  }
}

// At a minimum, moving a vertex costs energy, and to the first order none.
TEST(Energy, EveryInnerVertexIsAtItsMinimum) {
  for (const char* signature : {"532", "22", "*432", "*22"}) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    std::vector<char> fixed(sample.embedding().source_vertex.size(), 0);
    for (const Seam& seam : sample.embedding().seams)
      for (std::size_t k = 0; k < seam.left.size(); ++k) fixed[seam.left[k]] = fixed[seam.right[k]] = 1;
    const double least = energy(sample, sample.embedding());
    for (int v = 0; v < test::vertex_count(sample.mesh); v += 7) {
      if (fixed[v]) continue;
      const Vector3 p = sample.embedding().positions.row(v);
      const Vector3 u = p.unitOrthogonal();
      for (const Vector3& direction : {u, p.cross(u).eval()}) {
        const auto moved = [&](double step) {
          Embedding embedding = sample.embedding();
          embedding.positions.row(v) = (p + step * direction).normalized().transpose();
          return energy(sample, embedding);
        };
        EXPECT_GT(moved(1e-4), least) << signature << " " << v;
        EXPECT_GT(moved(-1e-4), least) << signature << " " << v;
        EXPECT_NEAR((moved(1e-4) - moved(-1e-4)) / 2e-4, 0, 1e-6) << signature << " " << v;
      }
    }
  }
}

// Every conformal map of a surface has twice its image's area, and no map has less; the sum over straight
// edges differs by the discretisation.
TEST(Energy, IsAtLeastTwiceTheArea) {
  for (const std::string& signature : test::sample_signatures()) {
    const test::SampleEmbedding& sample = test::sample_embedding(signature);
    EXPECT_GE(sample.result.minimum.energy, 8 * pi / sample.embedding().target.group_order) << signature;
  }
}

}  // namespace
}  // namespace orbitutte::energy_test
