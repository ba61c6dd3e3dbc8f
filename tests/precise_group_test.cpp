// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/precise_group.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <string>
#include <vector>

#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/tile.h"
#include "planar_families.h"
#include "spherical_families.h"

namespace orbitutte::precise_group_test {
namespace {

std::vector<Target> all_targets() {
  std::vector<Target> targets;
  for (const test::SphericalOrbifold& orbifold : test::arranged_orbifolds())
    targets.push_back(parse_orbifold(test::symbol(orbifold)));
  for (std::string text : test::planar_signatures()) {
    const auto orders = text.begin() + (text[0] == '*');
    std::sort(orders, text.end());
    do {
      targets.push_back(parse_orbifold(text));
    } while (std::next_permutation(orders, text.end()));
  }
  return targets;
}

template <typename Real>
double largest(const Real& matrix) {
  return static_cast<double>(matrix.cwiseAbs().maxCoeff());
}

/// J^-1 M^T J M - 1 with J = diag(1, 1, k), or its counterpart in the plane.
template <typename Real>
double isometry_defect(Space space, const Matrix3Of<Real>& M) {
  Matrix3Of<Real> J = Matrix3Of<Real>::Identity();
  J(2, 2) = space.curvature();
  Matrix3Of<Real> defect = M.transpose() * J * M - J;
  if (space.curvature() != 0) return largest(defect);
  return std::max(largest(defect.template topLeftCorner<2, 2>()),
                  largest(M.row(2) - Matrix3Of<Real>::Identity().row(2)));
}

/// By how much what has to hold of the gluing's elements and corners in exact numbers fails, at most: they
/// are isometries, agree with doubles to rounding, take the ends of their sides to each other, and products
/// of two are the elements near the products in double.
template <typename Real>
struct Failures {
  double off_doubles = 0, isometry = 0, product = 0, corner = 0;
};

template <typename Real>
Failures<Real> failures(const Target& target) {
  const PreciseGroup<Real> group(target);
  const Tile tile = basic_tile(target, first_arrangement(target));
  const int sides = static_cast<int>(tile.sides.size());
  Failures<Real> worst;
  for (int k = 0; k < sides; ++k) {
    const TileSide& side = tile.sides[k];
    const Matrix3Of<Real> element = group.element(side.transform);
    const auto take = [](double& most, double value) { most = std::max(most, value); };
    take(worst.off_doubles, largest(element.template cast<double>() - side.transform.matrix()));
    take(worst.isometry, isometry_defect(target.space, element));
    for (const TileSide& other : tile.sides) {
      const Isometry both = side.transform * other.transform;
      take(worst.product, largest(group.element(both) - element * group.element(other.transform)));
      take(worst.product,
           largest(group.element(both.inverse()) * group.element(both) - Matrix3Of<Real>::Identity()));
    }
    const TileSide& partner = tile.sides[side.partner];
    const bool reverses = side.partner_reverses() && side.partner != k;
    const Vector3 start = partner.start, end = tile.sides[(side.partner + 1) % sides].start;
    const Vector3Of<Real> here = group.held_point(side.start),
                          there = group.held_point(reverses ? end : start);
    // The end of a cut lies anywhere on its mirror: only one of its copies may be asked for.
    if (!side.slides && !(target.is_free_to_rotate && std::abs(side.start.z()) < 0.5))
      take(worst.corner, largest(here - element * there));
    take(worst.off_doubles, largest(here.template cast<double>() - side.start));
  }
  return worst;
}

template <typename Real>
void expect_precise(double rounding) {
  for (const Target& target : all_targets()) {
    SCOPED_TRACE(target.signature);
    const Failures<Real> worst = failures<Real>(target);
    EXPECT_LT(worst.off_doubles, 2e-14) << "half of that is lost in tiles of order 100";
    EXPECT_LT(worst.isometry, rounding);
    EXPECT_LT(worst.product, rounding);
    EXPECT_LT(worst.corner, rounding);
  }
}

TEST(PreciseGroup, ElementsAndCornersFitTogetherToTheLastBits) { expect_precise<Precise>(1e-92); }

TEST(PreciseGroup, DoublesGoThroughTheSameFormulas) { expect_precise<double>(2e-13); }

TEST(PreciseGroup, MostDigitsThereAre) {
  for (const char* signature : {"532", "12,12", "2*3", "3x", "*632"}) {
    SCOPED_TRACE(signature);
    const Failures<MostPrecise> worst = failures<MostPrecise>(parse_orbifold(signature));
    EXPECT_EQ(worst.isometry, 0) << "below the least double";
    EXPECT_EQ(worst.product, 0);
    EXPECT_EQ(worst.corner, 0);
  }
}

TEST(PreciseGroup, ARotationOfOrderNIsOneToItsNthPower) {
  const Target target = parse_orbifold("100,100");
  const PreciseGroup<Precise> group(target);
  const Matrix3Of<Precise> turn =
      group.element(basic_tile(target, first_arrangement(target)).sides[0].transform);
  Matrix3Of<Precise> power = turn;
  for (int k = 1; k < 100; ++k) {
    ASSERT_GT(largest(power - Matrix3Of<Precise>::Identity()), 0.05);
    power = power * turn;
  }
  EXPECT_LT(largest(power - Matrix3Of<Precise>::Identity()), 1e-92);
}

TEST(PreciseGroup, FarTranslationsOfThePlaneAreWhole) {
  const Target target = parse_orbifold("632");
  const Tile tile = basic_tile(target, first_arrangement(target));
  const Isometry translation =
      tile.sides[0].transform * tile.sides[2].transform * tile.sides[0].transform * tile.sides[2].transform;
  Isometry far;
  for (int k = 0; k < 50; ++k) far = far * translation * tile.sides[0].transform * translation;
  const PreciseGroup<Precise> group(target);
  const Matrix3Of<Precise> element = group.element(far);
  EXPECT_LT(isometry_defect(target.space, element), 1e-90);
  EXPECT_LT(largest(element.cast<double>() - far.matrix()), 1e-10);
}

TEST(PreciseGroup, TilesMayLieTurnedWhereTheirTargetIsFree) {
  for (const char* signature : {"77", "5*", "3x"}) {
    SCOPED_TRACE(signature);
    const Target target = parse_orbifold(signature);
    const PreciseGroup<Precise> group(target);
    const Isometry turn = Space::sphere().rotation(Space::origin(), 1.234);
    const Tile tile = moved_tile(basic_tile(target, first_arrangement(target)), turn);
    for (const TileSide& side : tile.sides)
      EXPECT_LT(largest(group.element(side.transform).cast<double>() - side.transform.matrix()), 4e-15);
  }
}

TEST(PreciseGroup, HeldPointsOffAllLinesStayWhereTheyAre) {
  const PreciseGroup<Precise> group(parse_orbifold("532"));
  const Vector3 point = Vector3(0.1, 0.05, 0.9).normalized();
  const Vector3Of<Precise> held = group.held_point(point);
  EXPECT_LT(largest(held.cast<double>() - point), 4e-16);
  EXPECT_LT(std::abs(static_cast<double>(held.squaredNorm() - 1)), 1e-92);
}

TEST(PreciseGroup, RefusesWhatIsNoElement) {
  const PreciseGroup<Precise> group(parse_orbifold("532"));
  EXPECT_THROW(group.element(Space::sphere().rotation(Space::origin(), 1)), ArgumentError);
  EXPECT_THROW(group.element(Space::sphere().rotation(Space::origin(), 0.4 * 3.14159265)), ArgumentError);
  Matrix3 broken = Matrix3::Identity();
  broken(0, 0) = std::nan("");
  EXPECT_THROW(group.element(Isometry(broken, broken)), ArgumentError);
  broken(0, 0) = 1;
  broken(0, 2) = 1e300;
  EXPECT_THROW(PreciseGroup<Precise>(parse_orbifold("632")).element(Isometry(broken, broken)), ArgumentError);
}

TEST(PreciseGroup, AFixedPolygonHasTheIdentityOnly) {
  Target target;
  target.signature = polygon_signature;
  target.corners.resize(3);
  const PreciseGroup<Precise> group(target);
  EXPECT_EQ(largest(group.element(Isometry()) - Matrix3Of<Precise>::Identity()), 0);
  EXPECT_THROW(group.element(Space::sphere().rotation(Space::origin(), 0.1)), ArgumentError);
  const Vector3 point = Vector3(1, 2, 3).normalized();
  EXPECT_LT(largest(group.held_point(point).cast<double>() - point), 4e-16);
}

}  // namespace
}  // namespace orbitutte::precise_group_test
