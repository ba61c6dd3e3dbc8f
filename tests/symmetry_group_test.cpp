// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/symmetry_group.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <limits>
#include <set>

#include "hand_made.h"

namespace orbitutte {
namespace {

using hand_made::reflection;
using hand_made::rotation;
using hand_made::Triangle;
using Generators = std::vector<Matrix3>;

constexpr double pi = std::numbers::pi;

Generators mirrors(int n1, int n2, int n3) {
  const Triangle triangle(n1, n2, n3);
  return {triangle.mirror_ab(), triangle.mirror_bc(), triangle.mirror_ca()};
}

Generators rotations(int n1, int n2, int n3) {
  const Triangle triangle(n1, n2, n3);
  return {rotation(triangle.a, 2 * pi / n1), rotation(triangle.c, 2 * pi / n3)};
}

/// The rotary reflection of order 2N about the z axis.
Matrix3 rotary_reflection(int N) { return reflection(Vector3::UnitZ()) * rotation(Vector3::UnitZ(), pi / N); }

int order(const Generators& generators) { return SymmetryGroup(generators, 1000).order(); }

int mirrored(const SymmetryGroup& group) {
  int count = 0;
  for (const Matrix3& g : group.elements()) count += g.determinant() < 0;
  return count;
}

/// Closed under products and inverses, element by element, and no element twice.
void expect_group(const SymmetryGroup& group) {
  EXPECT_EQ(group.elements()[0], Matrix3::Identity());
  for (int g = 0; g < group.order(); ++g) {
    const Matrix3& element = group.elements()[g];
    EXPECT_EQ(group.find(element), g);
    EXPECT_GE(group.find(element.transpose()), 0);
    EXPECT_LE((element.transpose() * element - Matrix3::Identity()).norm(), 1e-15);
    const std::vector<int> products = group.right_products(element);
    EXPECT_EQ(std::set<int>(products.begin(), products.end()).size(), group.elements().size());
  }
}

TEST(SymmetryGroup, OfNothingIsTheIdentity) {
  const SymmetryGroup group({}, 1);
  EXPECT_EQ(group.order(), 1);
  EXPECT_EQ(group.find(Matrix3::Identity()), 0);
}

TEST(SymmetryGroup, PolyhedralRotations) {
  EXPECT_EQ(order(rotations(5, 3, 2)), 60);
  EXPECT_EQ(order(rotations(4, 3, 2)), 24);
  EXPECT_EQ(order(rotations(3, 3, 2)), 12);
  EXPECT_EQ(order(rotations(2, 3, 5)), 60);
  expect_group(SymmetryGroup(rotations(5, 3, 2), 60));
}

TEST(SymmetryGroup, PolyhedralReflections) {
  EXPECT_EQ(order(mirrors(5, 3, 2)), 120);
  EXPECT_EQ(order(mirrors(4, 3, 2)), 48);
  EXPECT_EQ(order(mirrors(3, 3, 2)), 24);
  const SymmetryGroup group(mirrors(5, 3, 2), 120);
  expect_group(group);
  EXPECT_EQ(mirrored(group), 60);
}

TEST(SymmetryGroup, CyclicAndDihedral) {
  for (const int N : {2, 3, 4, 5, 7, 12, 31, 100}) {
    const Vector3 z = Vector3::UnitZ();
    EXPECT_EQ(order({rotation(z, 2 * pi / N)}), N);  // NN
    EXPECT_EQ(order(rotations(N, 2, 2)), 2 * N);     // 22N
    EXPECT_EQ(order(mirrors(N, 2, 2)), 4 * N);       // *22N
    EXPECT_EQ(order({reflection(Vector3::UnitX()), reflection({-std::cos(pi / N), std::sin(pi / N), 0})}),
              2 * N);                                                               // *NN
    EXPECT_EQ(order({rotation(z, 2 * pi / N), reflection(z)}), 2 * N);              // N*
    EXPECT_EQ(order({rotary_reflection(N)}), 2 * N);                                // Nx
    EXPECT_EQ(order({rotary_reflection(N), reflection(Vector3::UnitX())}), 4 * N);  // 2*N
  }
  EXPECT_EQ(order({-Matrix3::Identity()}), 2);                                            // 1x
  EXPECT_EQ(order({rotation({1, 1, 1}, 2 * pi / 3), reflection(Vector3::UnitX())}), 24);  // 3*2
}

TEST(SymmetryGroup, StaysExactInLongProducts) {
  const int N = 4096;
  const Vector3 axis = Vector3(1, 2, 3).normalized();
  const SymmetryGroup group({rotation(axis, 2 * pi / N), reflection(axis)}, 2 * N);
  ASSERT_EQ(group.order(), 2 * N);
  for (int k = 0; k < N; ++k) {
    const int g = group.find(rotation(axis, 2 * pi * k / N));
    ASSERT_GE(g, 0);
    ASSERT_LE((group.elements()[g] - rotation(axis, 2 * pi * k / N)).norm(), 1e-11);
    ASSERT_LE((group.elements()[g].transpose() * group.elements()[g] - Matrix3::Identity()).norm(), 1e-15);
  }
}

TEST(SymmetryGroup, FindsTheNearestElementOrNone) {
  const SymmetryGroup group(rotations(4, 3, 2), 24);
  for (int g = 0; g < group.order(); ++g) {
    const Matrix3& element = group.elements()[g];
    EXPECT_EQ(group.find(element * rotation({1, 2, 3}, 5e-7)), g);
    EXPECT_EQ(group.find(element * rotation({1, 2, 3}, 1e-5)), -1);
  }
  EXPECT_EQ(group.find(-Matrix3::Identity()), -1);
  EXPECT_EQ(group.find(Matrix3::Constant(std::numeric_limits<double>::quiet_NaN())), -1);
}

TEST(SymmetryGroup, DependsOnTheGeneratorsAlone) {
  const SymmetryGroup first(mirrors(5, 3, 2), 120);
  const SymmetryGroup second(mirrors(5, 3, 2), 1000);
  EXPECT_EQ(first.elements(), second.elements());
}

TEST(SymmetryGroup, RefusesInfiniteGroups) {
  EXPECT_THROW(SymmetryGroup({rotation(Vector3::UnitZ(), 1.0)}, 10000), ArgumentError);
  EXPECT_THROW(
      SymmetryGroup({rotation(Vector3::UnitZ(), pi / 2), rotation(Vector3::UnitX(), 2 * pi / 5)}, 1000),
      ArgumentError);
  EXPECT_THROW(SymmetryGroup(rotations(5, 3, 2), 59), ArgumentError);
  EXPECT_NO_THROW(SymmetryGroup(rotations(5, 3, 2), 60));
}

TEST(SymmetryGroup, RefusesWhatIsNotOrthogonal) {
  EXPECT_THROW(SymmetryGroup({2 * Matrix3::Identity()}, 10), ArgumentError);
  EXPECT_THROW(SymmetryGroup({(1 + 1e-8) * Matrix3::Identity()}, 10), ArgumentError);
  EXPECT_THROW(SymmetryGroup({Matrix3::Constant(std::numeric_limits<double>::quiet_NaN())}, 10),
               ArgumentError);
  EXPECT_NO_THROW(SymmetryGroup({(1 + 1e-11) * reflection(Vector3::UnitX())}, 2));
}

TEST(SymmetryGroup, RefusesProductsWithStrangers) {
  const SymmetryGroup group(rotations(5, 3, 2), 60);
  EXPECT_THROW(group.right_products(-Matrix3::Identity()), ArgumentError);
}

}  // namespace
}  // namespace orbitutte
