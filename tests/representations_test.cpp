// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/representations.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <numbers>

#include "hand_made.h"
#include "orbitutte/orbifold/signature.h"
#include "spherical_families.h"

namespace orbitutte::representations_test {
namespace {

using std::numbers::pi;
using testing::ElementsAre;

SymmetryGroup group_of(const std::string& signature) { return group_of(parse_orbifold(signature)); }

std::vector<std::string> all_signatures() {
  std::vector<std::string> result;
  for (const test::SphericalOrbifold& orbifold : test::spherical_orbifolds())
    if (orbifold.group_order <= 120) result.push_back(test::symbol(orbifold));
  return result;
}

std::vector<int> dimensions(const std::vector<Representation>& kinds) {
  std::vector<int> result;
  for (const Representation& kind : kinds) result.push_back(kind.dimension);
  return result;
}

TEST(Representations, FillTheSpaceOfFunctionsOnTheGroup) {
  for (const std::string& signature : all_signatures()) {
    const SymmetryGroup group = group_of(signature);
    int sum = 0;
    for (const Representation& kind : irreducible_representations(group))
      sum += kind.multiplicity * kind.dimension;
    EXPECT_EQ(sum, group.order()) << signature;
  }
}

TEST(Representations, AreOrthogonalAndMultiplyAsTheGroupDoes) {
  for (const char* signature : {"532", "*332", "2*5", "5*", "55", "*225"}) {
    const SymmetryGroup group = group_of(signature);
    for (const Representation& kind : irreducible_representations(group)) {
      for (int h = 0; h < group.order(); h += 3) {
        const Eigen::MatrixXd& rho = kind.matrices[h];
        EXPECT_TRUE((rho.transpose() * rho).isIdentity(1e-12)) << signature;
        const std::vector<int> products = group.right_products(group.elements()[h]);
        for (int g = 0; g < group.order(); ++g)
          EXPECT_TRUE(kind.matrices[products[g]].isApprox(kind.matrices[g] * rho, 1e-10)) << signature;
      }
    }
  }
}

TEST(Representations, OfDifferentKindsHaveOrthogonalCharacters) {
  for (const std::string& signature : all_signatures()) {
    const std::vector<Representation> kinds = irreducible_representations(group_of(signature));
    for (std::size_t a = 0; a < kinds.size(); ++a) {
      for (std::size_t b = 0; b < a; ++b) {
        double product = 0;
        for (std::size_t g = 0; g < kinds[a].matrices.size(); ++g)
          product += kinds[a].matrices[g].trace() * kinds[b].matrices[g].trace();
        EXPECT_NEAR(product, 0, 1e-8) << signature;
      }
    }
  }
}

TEST(Representations, OfTheIcosahedronHaveTheKnownDimensions) {
  EXPECT_THAT(dimensions(irreducible_representations(group_of("532"))), ElementsAre(1, 3, 3, 4, 5));
  EXPECT_THAT(dimensions(irreducible_representations(group_of("*532"))),
              ElementsAre(1, 1, 3, 3, 3, 3, 4, 4, 5, 5));
}

// Over the complex numbers the turns split into two of dimension one, so each occurs once only.
TEST(Representations, OfTurnsAboutAnAxisArePlaneRotations) {
  const std::vector<Representation> kinds = irreducible_representations(group_of("55"));
  EXPECT_THAT(dimensions(kinds), ElementsAre(1, 2, 2));
  for (const Representation& kind : kinds) EXPECT_EQ(kind.multiplicity, 1);
}

TEST(Representations, SpaceHasThreeDimensionsOfThem) {
  for (const std::string& signature : all_signatures()) {
    const SymmetryGroup group = group_of(signature);
    int sum = 0;
    for (const Representation& kind : irreducible_representations(group))
      sum += kind.multiplicity * occurrences_in_space(kind, group);
    EXPECT_EQ(sum, 3) << signature;
  }
}

TEST(Representations, FixedVectorsAreTheAxisOfATurnAndThePlaneOfAMirror) {
  Representation space;
  space.dimension = 3;
  const Vector3 axis = Vector3(1, 2, 3).normalized();
  space.matrices = {Matrix3::Identity(), hand_made::rotation(axis, 2 * pi / 3), hand_made::reflection(axis)};
  EXPECT_EQ(fixed_vectors(space, {}).cols(), 3);
  EXPECT_EQ(fixed_vectors(space, {0}).cols(), 3);
  const Eigen::MatrixXd line = fixed_vectors(space, {1});
  ASSERT_EQ(line.cols(), 1);
  EXPECT_NEAR(std::abs(axis.dot(Vector3(line.col(0)))), 1, 1e-12);
  const Eigen::MatrixXd plane = fixed_vectors(space, {2});
  ASSERT_EQ(plane.cols(), 2);
  EXPECT_NEAR((axis.transpose() * plane).norm(), 0, 1e-12);
  EXPECT_EQ(fixed_vectors(space, {1, 2}).cols(), 0);
}

}  // namespace
}  // namespace orbitutte::representations_test
