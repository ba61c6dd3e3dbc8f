// SPDX-License-Identifier: MIT
#include "orbitutte/verify/theorem2.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "hand_made.h"
#include "orbitutte/output/tiling.h"
#include "sample_embeddings.h"

namespace orbitutte {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

Theorem2 theorem2_of(const Mesh& mesh, const EdgeWeights& weights, const Embedding& embedding) {
  return check_theorem2(connect(mesh.F, test::vertex_count(mesh)), weights, embedding);
}

Theorem2 theorem2_of(const std::string& signature) {
  const test::SampleEmbedding& sample = test::sample_embedding(signature);
  return theorem2_of(sample.mesh, sample.result.weights, sample.embedding());
}

TEST(Theorem2, HoldsForTheSamplesOfAllFamilies) {
  for (const std::string& signature : test::sample_signatures()) {
    const Theorem2 theorem2 = theorem2_of(signature);
    EXPECT_EQ(theorem2.status, Theorem2::Status::measured) << signature << ": " << theorem2.detail;
    EXPECT_EQ(theorem2.negative, 1) << signature;
    EXPECT_EQ(theorem2.kernel, 3) << signature;
    EXPECT_LT(theorem2.kernel_residual, 1e-6) << signature;
    const double longest = test::sample_embedding(signature).result.certificate.max_edge_length;
    EXPECT_DOUBLE_EQ(theorem2.max_edge_length, longest) << signature;
    EXPECT_EQ(theorem2.holds(), longest < pi / 2) << signature;
  }
}

}  // namespace
}  // namespace orbitutte
