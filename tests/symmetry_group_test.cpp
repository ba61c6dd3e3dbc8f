// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/symmetry_group.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <limits>
#include <set>

#include "hand_made.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/tile.h"
#include "planar_families.h"

namespace orbitutte::symmetry_group_test {
namespace {

using hand_made::reflection;
using hand_made::rotation;
using hand_made::symmetry;
using hand_made::Triangle;
using Generators = std::vector<Isometry>;

using std::numbers::pi;

Generators symmetries(const std::vector<Matrix3>& matrices) {
  Generators generators;
  for (const Matrix3& matrix : matrices) generators.push_back(symmetry(matrix));
  return generators;
}

Generators mirrors(int n1, int n2, int n3) {
  const Triangle triangle(n1, n2, n3);
  return symmetries({triangle.mirror_ab(), triangle.mirror_bc(), triangle.mirror_ca()});
}

Generators rotations(int n1, int n2, int n3) {
  const Triangle triangle(n1, n2, n3);
  return symmetries({rotation(triangle.a, 2 * pi / n1), rotation(triangle.c, 2 * pi / n3)});
}

/// The rotary reflection of order 2N about the z axis.
Matrix3 rotary_reflection(int N) { return reflection(Vector3::UnitZ()) * rotation(Vector3::UnitZ(), pi / N); }

SymmetryGroup finite(const Generators& generators, int max_order) {
  return {Space::sphere(), generators, max_order};
}

SymmetryGroup finite(const std::vector<Matrix3>& matrices, int max_order) {
  return finite(symmetries(matrices), max_order);
}

int order(const Generators& generators) { return finite(generators, 1000).order(); }

int order(const std::vector<Matrix3>& generators) { return finite(generators, 1000).order(); }

int mirrored(const SymmetryGroup& group) {
  int count = 0;
  for (const Isometry& g : group.elements()) count += g.reverses_orientation();
  return count;
}

/// Closed under products and inverses, element by element, and no element twice.
void expect_group(const SymmetryGroup& group) {
  EXPECT_TRUE(group.elements()[0].is_identity());
  for (int g = 0; g < group.order(); ++g) {
    const Isometry& element = group.elements()[g];
    EXPECT_EQ(group.find(element), g);
    EXPECT_GE(group.find(element.inverse()), 0);
    EXPECT_LE((element.inverse() * element).difference({}), 1e-15);
    const std::vector<int> products = group.right_products(element);
    EXPECT_EQ(std::set<int>(products.begin(), products.end()).size(), group.elements().size());
    EXPECT_EQ(std::count(products.begin(), products.end(), -1), 0);
  }
}

TEST(SymmetryGroup, OfNothingIsTheIdentity) {
  const SymmetryGroup group = finite(Generators(), 1);
  EXPECT_EQ(group.order(), 1);
  EXPECT_EQ(group.find({}), 0);
}

TEST(SymmetryGroup, PolyhedralRotations) {
  EXPECT_EQ(order(rotations(5, 3, 2)), 60);
  EXPECT_EQ(order(rotations(4, 3, 2)), 24);
  EXPECT_EQ(order(rotations(3, 3, 2)), 12);
  EXPECT_EQ(order(rotations(2, 3, 5)), 60);
  expect_group(finite(rotations(5, 3, 2), 60));
}

TEST(SymmetryGroup, PolyhedralReflections) {
  EXPECT_EQ(order(mirrors(5, 3, 2)), 120);
  EXPECT_EQ(order(mirrors(4, 3, 2)), 48);
  EXPECT_EQ(order(mirrors(3, 3, 2)), 24);
  const SymmetryGroup group = finite(mirrors(5, 3, 2), 120);
  expect_group(group);
  EXPECT_EQ(mirrored(group), 60);
}

TEST(SymmetryGroup, CyclicAndDihedral) {
  for (const int N : {2, 3, 4, 5, 7, 12, 31, 100}) {
    const Vector3 z = Vector3::UnitZ();
    const std::vector<Matrix3> about_axis = {rotation(z, 2 * pi / N)};
    const std::vector<Matrix3> rotary = {rotary_reflection(N)};
    EXPECT_EQ(order(about_axis), N);              // NN
    EXPECT_EQ(order(rotations(N, 2, 2)), 2 * N);  // 22N
    EXPECT_EQ(order(mirrors(N, 2, 2)), 4 * N);    // *22N
    EXPECT_EQ(order(std::vector<Matrix3>{reflection(Vector3::UnitX()),
                                         reflection({-std::cos(pi / N), std::sin(pi / N), 0})}),
              2 * N);                                                                        // *NN
    EXPECT_EQ(order(std::vector<Matrix3>{about_axis[0], reflection(z)}), 2 * N);             // N*
    EXPECT_EQ(order(rotary), 2 * N);                                                         // Nx
    EXPECT_EQ(order(std::vector<Matrix3>{rotary[0], reflection(Vector3::UnitX())}), 4 * N);  // 2*N
  }
  const std::vector<Matrix3> antipodal = {-Matrix3::Identity()};
  EXPECT_EQ(order(antipodal), 2);  // 1x
  EXPECT_EQ(order(std::vector<Matrix3>{rotation({1, 1, 1}, 2 * pi / 3), reflection(Vector3::UnitX())}),
            24);  // 3*2
}

TEST(SymmetryGroup, StaysExactInLongProducts) {
  const int N = 4096;
  const Vector3 axis = Vector3(1, 2, 3).normalized();
  const SymmetryGroup group =
      finite(std::vector<Matrix3>{rotation(axis, 2 * pi / N), reflection(axis)}, 2 * N);
  ASSERT_EQ(group.order(), 2 * N);
  for (int k = 0; k < N; ++k) {
    const Isometry expected = symmetry(rotation(axis, 2 * pi * k / N));
    const int g = group.find(expected);
    ASSERT_GE(g, 0);
    ASSERT_LE(group.elements()[g].difference(expected), 1e-11);
    ASSERT_LE(Space::sphere().isometry_defect(group.elements()[g].matrix()), 1e-15);
  }
}

TEST(SymmetryGroup, FindsTheNearestElementOrNone) {
  const SymmetryGroup group = finite(rotations(4, 3, 2), 24);
  for (int g = 0; g < group.order(); ++g) {
    const Isometry& element = group.elements()[g];
    EXPECT_EQ(group.find(element * symmetry(rotation({1, 2, 3}, 5e-7))), g);
    EXPECT_EQ(group.find(element * symmetry(rotation({1, 2, 3}, 1e-5))), -1);
  }
  EXPECT_EQ(group.find(symmetry(-Matrix3::Identity())), -1);
  EXPECT_EQ(group.find(symmetry(Matrix3::Constant(std::numeric_limits<double>::quiet_NaN()))), -1);
}

TEST(SymmetryGroup, DependsOnTheGeneratorsAlone) {
  const SymmetryGroup first = finite(mirrors(5, 3, 2), 120), second = finite(mirrors(5, 3, 2), 1000);
  ASSERT_EQ(first.order(), second.order());
  for (int g = 0; g < first.order(); ++g)
    EXPECT_EQ(first.elements()[g].matrix(), second.elements()[g].matrix());
}

TEST(SymmetryGroup, RefusesInfiniteGroups) {
  const std::vector<Matrix3> irrational = {rotation(Vector3::UnitZ(), 1.0)};
  EXPECT_THROW(finite(irrational, 10000), ArgumentError);
  EXPECT_THROW(
      finite(std::vector<Matrix3>{rotation(Vector3::UnitZ(), pi / 2), rotation(Vector3::UnitX(), 2 * pi / 5)},
             1000),
      ArgumentError);
  EXPECT_THROW(finite(rotations(5, 3, 2), 59), ArgumentError);
  EXPECT_NO_THROW(finite(rotations(5, 3, 2), 60));
}

TEST(SymmetryGroup, RefusesWhatIsNoIsometryOfTheSpace) {
  const auto refused = [](Space space, const Matrix3& matrix) {
    try {
      SymmetryGroup(space, {space.isometry(matrix)}, 10);
      return false;
    } catch (const ArgumentError&) {
      return true;
    }
  };
  const Matrix3 no_number = Matrix3::Constant(std::numeric_limits<double>::quiet_NaN());
  for (const Space space : {Space::sphere(), Space::plane(), Space::hyperbolic_plane()}) {
    EXPECT_TRUE(refused(space, 2 * Matrix3::Identity()));
    EXPECT_TRUE(refused(space, (1 + 1e-8) * Matrix3::Identity()));
    EXPECT_TRUE(refused(space, no_number));
    EXPECT_FALSE(refused(space, space.rotation(space.retract({0.1, 0.2, 1}), 2 * pi / 3).matrix()));
  }
  EXPECT_FALSE(refused(Space::sphere(), (1 + 1e-11) * reflection(Vector3::UnitX())));
}

TEST(SymmetryGroup, ProductsWithStrangersAreNoElements) {
  const SymmetryGroup group = finite(rotations(5, 3, 2), 60);
  const std::vector<int> products = group.right_products(symmetry(-Matrix3::Identity()));
  EXPECT_EQ(std::count(products.begin(), products.end(), -1), 60);
}

TEST(SymmetryGroup, ConjugatesAreTheGroupWhereThePointsHaveGone) {
  const SymmetryGroup group = finite(rotations(4, 3, 2), 24);
  const Isometry moved = symmetry(rotation({1, 2, 3}, 0.8));
  const SymmetryGroup there = group.conjugated(moved);
  ASSERT_EQ(there.order(), group.order());
  const Vector3 p = Vector3(0.3, -0.5, 0.7).normalized();
  for (int g = 0; g < group.order(); ++g)
    EXPECT_LE((there.elements()[g] * (moved * p) - moved * (group.elements()[g] * p)).norm(), 1e-14);
  expect_group(there);
}

// --- infinite groups

std::vector<double> distances(const Target& target, const SymmetryGroup& group, const Vector3& centre) {
  std::vector<double> result;
  for (const Isometry& g : group.elements()) result.push_back(target.space.distance(centre, g * centre));
  return result;
}

Vector3 middle_of(const Target& target) { return basic_tile(target, first_arrangement(target)).centroid(); }

TEST(NearestElements, BeginWithTheIdentityAndGoOutwards) {
  for (const std::string& signature : test::planar_signatures()) {
    const Target target = parse_orbifold(signature);
    const SymmetryGroup group = group_of(target, 200);
    EXPECT_EQ(group.order(), 200) << signature;
    EXPECT_TRUE(group.elements()[0].is_identity());
    const std::vector<double> away = distances(target, group, middle_of(target));
    for (std::size_t g = 1; g < away.size(); ++g) EXPECT_GE(away[g], away[g - 1] - 1e-9) << signature;
    for (int g = 0; g < group.order(); ++g) {
      EXPECT_EQ(group.find(group.elements()[g]), g) << signature;  // none twice
      EXPECT_LE(target.space.isometry_defect(group.elements()[g].matrix()), 1e-13) << signature;
    }
  }
}

TEST(NearestElements, LeaveNoneOutThatIsNear) {
  for (const std::string& signature : test::planar_signatures()) {
    const Target target = parse_orbifold(signature);
    const SymmetryGroup group = group_of(target, 300);
    const Vector3 centre = middle_of(target);
    const double reach = distances(target, group, centre).back();
    for (const Isometry& g : group.elements()) {
      for (const Isometry& h : {group.elements()[1], group.elements()[2], g}) {
        const Isometry product = g * h;
        if (target.space.distance(centre, product * centre) > reach - 1e-6) continue;
        EXPECT_GE(group.find(product), 0) << signature;
      }
      if (target.space.distance(centre, g.inverse() * centre) < reach - 1e-6) {
        EXPECT_GE(group.find(g.inverse()), 0) << signature;
      }
    }
  }
}

// Copies of the tile fill the plane: so many of them lie in a disk as its area has room for, but for its rim.
TEST(NearestElements, AreAsManyAsTheAreaHasRoomFor) {
  for (const std::string& signature : test::planar_signatures()) {
    const Target target = parse_orbifold(signature);
    const Tile tile = basic_tile(target, first_arrangement(target));
    double area = 0;
    for (const TileSide& side : tile.sides)
      area += target.space.area(tile.centroid(), side.start, side.point(side.length));
    const int count = 2000;
    const double radius = distances(target, group_of(target, count), tile.centroid()).back();
    EXPECT_NEAR(pi * radius * radius / area, count, 0.1 * count) << signature;
  }
}

// The rotations of the triangle with angles pi/7, pi/3 and pi/2, about two of its corners. Far from the
// origin their entries are so large that products differ by more than 1e-6 in the order in which they are
// formed.
TEST(NearestElements, AreDifferentFarOutInTheHyperbolicPlane) {
  const Space space = Space::hyperbolic_plane();
  const double side = std::acosh(std::cos(pi / 7) * std::cos(pi / 3) / (std::sin(pi / 7) * std::sin(pi / 3)));
  const Vector3 corner(0, 0, 1), other(std::sinh(side), 0, std::cosh(side));
  for (const double distance : {0.0, 2.0, 3.0}) {
    const Isometry outward = space.to_origin(Vector3(0, std::sinh(distance), std::cosh(distance))).inverse();
    const std::vector<Isometry> generators = {
        outward * space.rotation(corner, 2 * pi / 7) * outward.inverse(),
        outward * space.rotation(other, 2 * pi / 3) * outward.inverse()};
    const Vector3 centre = outward * space.retract(corner + 0.6 * other + Vector3(0, 0.1, 0));
    const SymmetryGroup group = SymmetryGroup::nearest_elements(space, generators, centre, 300);
    double nearest = 9;
    for (int g = 0; g < group.order(); ++g)
      for (int h = 0; h < g; ++h)
        nearest =
            std::min(nearest, space.distance(group.elements()[g] * centre, group.elements()[h] * centre));
    EXPECT_GT(nearest, 0.05) << distance;
  }
}

TEST(NearestElements, OfAFiniteGroupAreAllOfIt) {
  for (const char* signature : {"532", "*332", "2*5", "3x"}) {
    const Target target = parse_orbifold(signature);
    std::vector<Isometry> generators;
    for (const TileSide& side : basic_tile(target, first_arrangement(target)).sides)
      generators.push_back(side.transform);
    const SymmetryGroup group =
        SymmetryGroup::nearest_elements(target.space, generators, middle_of(target), 1000);
    EXPECT_EQ(group.order(), target.group_order);
    expect_group(group);
  }
}

TEST(GroupOf, ATargetIsThatOfItsSignature) {
  for (const char* signature : {"532", "*432", "22", "5*", "2*3", "4x"}) {
    const Target target = parse_orbifold(signature);
    EXPECT_EQ(group_of(target).order(), target.group_order);
    EXPECT_EQ(group_of(target, 3).order(), target.group_order) << "a finite group is asked for some elements";
  }
  for (const std::string& signature : test::planar_signatures())
    EXPECT_THROW(group_of(parse_orbifold(signature)), ArgumentError);
}

TEST(GroupOf, ATargetThatClaimsAnotherOrderIsRefused) {
  Target target = parse_orbifold("432");
  for (const int wrong : {-1, 0, 1, 12, 23, 25, 48}) {
    target.group_order = wrong;
    EXPECT_THROW(group_of(target), ArgumentError) << wrong;
  }
}

}  // namespace
}  // namespace orbitutte::symmetry_group_test
