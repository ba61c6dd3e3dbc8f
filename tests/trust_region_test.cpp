// SPDX-License-Identifier: MIT
#include "orbitutte/solve/trust_region.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

namespace orbitutte::trust_region_test {
namespace {

QuadraticModel random_model(int size, double shift, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd root(size, size);
  for (double& entry : root.reshaped()) entry = normal(random);
  QuadraticModel model = {Eigen::VectorXd(size), root + root.transpose()};
  for (double& entry : model.gradient) entry = normal(random);
  model.hessian.diagonal().array() += shift;
  return model;
}

TEST(TrustRegion, TheStepOfAConvexModelIsNewtonsIfItFits) {
  const QuadraticModel model = random_model(6, 20, 1);
  const Eigen::VectorXd newton = -model.hessian.inverse() * model.gradient;
  EXPECT_LT((trust_region_step(model, 10) - newton).norm(), 1e-12);
}

TEST(TrustRegion, NoStepWithinTheRadiusIsBetter) {
  std::mt19937 random(7);
  std::normal_distribution<double> normal;
  for (std::uint32_t seed = 0; seed < 40; ++seed)
    for (const double radius : {0.01, 0.5, 3.0}) {
      const QuadraticModel model = random_model(5, seed % 2 == 0 ? 0 : 8, seed);
      const Eigen::VectorXd step = trust_region_step(model, radius);
      EXPECT_LE(step.norm(), radius * (1 + 1e-9));
      for (int trial = 0; trial < 200; ++trial) {
        Eigen::VectorXd other = Eigen::VectorXd::NullaryExpr(5, [&] { return normal(random); });
        if (trial % 2 == 0) other = step + 1e-2 * radius * other;
        if (other.norm() > radius) other *= radius / other.norm();
        EXPECT_GE(model(other), model(step) - 1e-9 * std::abs(model(step)));
      }
    }
}

TEST(TrustRegion, NoGradientNoStep) {
  EXPECT_EQ(trust_region_step({Eigen::VectorXd::Zero(3), -Eigen::MatrixXd::Identity(3, 3)}, 1).norm(), 0);
  EXPECT_EQ(trust_region_step({Eigen::VectorXd(0), Eigen::MatrixXd(0, 0)}, 1).size(), 0);
}

}  // namespace
}  // namespace orbitutte::trust_region_test
