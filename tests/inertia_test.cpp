// SPDX-License-Identifier: MIT
#include "orbitutte/verify/inertia.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <random>

namespace orbitutte::inertia_test {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

SymmetricMatrix lower_triangle(const MatrixXd& A) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < A.cols(); ++column)
    for (int row = column; row < A.rows(); ++row)
      if (row == column || A(row, column) != 0) entries.emplace_back(row, column, A(row, column));
  SymmetricMatrix lower(static_cast<int>(A.rows()), static_cast<int>(A.cols()));
  lower.setFromTriplets(entries.begin(), entries.end());
  return lower;
}

long below(const MatrixXd& A, double shift, InertiaMethod method) {
  return inertia_counter(lower_triangle(A), VectorXd::Ones(A.rows()), method)->eigenvalues_below(shift);
}

MatrixXd random_sparse(int n, std::uint32_t seed) {
  std::mt19937 random(seed);
  std::normal_distribution<double> normal;
  MatrixXd A = MatrixXd::Zero(n, n);
  for (int k = 0; k < 3 * n; ++k) {
    const int i = static_cast<int>(random() % n), j = static_cast<int>(random() % n);
    A(i, j) = A(j, i) = normal(random);
  }
  return A;
}

TEST(Inertia, OfADiagonalMatrixIsRead) {
  const MatrixXd A = VectorXd::LinSpaced(7, -3, 3).asDiagonal();
  for (const InertiaMethod method : available_inertia_methods()) {
    EXPECT_EQ(below(A, -3.5, method), 0) << name_of(method);
    EXPECT_EQ(below(A, -0.5, method), 3) << name_of(method);
    EXPECT_EQ(below(A, 0.5, method), 4) << name_of(method);
    EXPECT_EQ(below(A, 10, method), 7) << name_of(method);
  }
}

TEST(Inertia, IsThatOfTheEigenvalues) {
  for (std::uint32_t seed = 0; seed < 10; ++seed) {
    const MatrixXd A = random_sparse(40, seed);
    const VectorXd scale = VectorXd::LinSpaced(40, 0.5, 2);
    const Eigen::GeneralizedSelfAdjointEigenSolver<MatrixXd> eigen(A, MatrixXd(scale.asDiagonal()));
    for (const InertiaMethod method : available_inertia_methods()) {
      const auto counter = inertia_counter(lower_triangle(A), scale, method);
      for (const double shift : {-1.3, -0.2, 0.1, 0.77, 2.0})
        EXPECT_EQ(counter->eigenvalues_below(shift), (eigen.eigenvalues().array() < shift).count())
            << name_of(method) << " " << seed << " " << shift;
    }
  }
}

// The first pivot is zero.
TEST(Inertia, WithoutPivotingABreakdownIsToldAndNotGuessed) {
  MatrixXd A(2, 2);
  A << 0, 1, 1, 0;
  try {
    below(A, 0, InertiaMethod::eigen);
    FAIL();
  } catch (const InertiaNotFound& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("MUMPS"));
  }
  // Here it is not quite zero, and L so large that the last pivot is rounding.
  A << 1e-14, 1, 1, 0.3;
  MatrixXd larger = MatrixXd::Identity(4, 4);
  larger.topLeftCorner(2, 2) = A;
  for (const InertiaMethod method : available_inertia_methods()) {
    if (method == InertiaMethod::eigen) continue;
    EXPECT_EQ(below(larger, 0, method), 1) << name_of(method);
  }
}

TEST(Inertia, MumpsPivots) {
  if (available_inertia_methods().front() != InertiaMethod::mumps)
    GTEST_SKIP() << "this binary was built without MUMPS";
  MatrixXd A(2, 2);
  A << 0, 1, 1, 0;
  EXPECT_EQ(below(A, 0, InertiaMethod::mumps), 1);
}

TEST(Inertia, WithoutMumpsThePackageIsNamed) {
  if (available_inertia_methods().front() == InertiaMethod::mumps)
    GTEST_SKIP() << "this binary was built with MUMPS";
  try {
    below(MatrixXd::Identity(2, 2), 0, InertiaMethod::mumps);
    FAIL();
  } catch (const ArgumentError& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("libmumps-seq-dev"));
  }
}

}  // namespace
}  // namespace orbitutte::inertia_test
