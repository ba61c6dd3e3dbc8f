// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/tile.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "orbitutte/orbifold/families.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "planar_families.h"
#include "spherical_families.h"

namespace orbitutte::tile_test {
namespace {

using std::numbers::pi;
constexpr double rounding = 1e-12;

struct Case {
  int mirrors;
  Target orbifold;
  std::vector<int> arrangement;
  Tile tile;
};

/// The order and kind of a corner: of a mark, or of an ordinary point on a mirror.
Mark mark_at(const Target& orbifold, std::size_t corner) {
  return corner < orbifold.marks.size() ? orbifold.marks[corner] : Mark::of_order(1, ConeKind::corner);
}

/// All sequences in which a boundary may meet the marks. Where rotations and mirrors mix, it is cut from the
/// cone to the mirror, where it has a corner of its own, the last index.
std::vector<std::vector<int>> arrangements(const Target& orbifold) {
  const int marks = static_cast<int>(orbifold.marks.size());
  if (orbifold.topology == Topology::disk && orbifold.inner_marks > 0)
    return {marks == 1 ? std::vector<int>{0, 1} : std::vector<int>{0, 2, 1}};
  std::vector<int> arrangement(marks);
  std::iota(arrangement.begin(), arrangement.end(), 0);
  std::vector<std::vector<int>> result;
  do {
    result.push_back(arrangement);
  } while (std::next_permutation(arrangement.begin(), arrangement.end()));
  return result;
}

bool is_first(const std::vector<int>& arrangement, const Target& orbifold) {
  return arrangement == arrangements(orbifold).front();
}

/// The tiles of all families with marks, of all arrangements of the orders, and of all sequences in which a
/// boundary may meet the marks.
const std::vector<Case>& cases() {
  static const std::vector<Case> all = [] {
    std::vector<Case> result;
    for (const test::SphericalOrbifold& spherical : test::arranged_orbifolds()) {
      if (spherical.orders.empty()) continue;  // no tile with corners at marks
      const Target orbifold = parse_orbifold(test::symbol(spherical));
      for (const std::vector<int>& arrangement : arrangements(orbifold))
        result.push_back({spherical.mirrors, orbifold, arrangement, basic_tile(orbifold, arrangement)});
    }
    for (std::string text : test::planar_signatures()) {
      const auto orders = text.begin() + (text[0] == '*');
      std::sort(orders, text.end());
      do {
        const Target orbifold = parse_orbifold(text);
        const int mirrors = text[0] == '*' ? static_cast<int>(orbifold.marks.size()) : 0;
        for (const std::vector<int>& arrangement : arrangements(orbifold))
          result.push_back({mirrors, orbifold, arrangement, basic_tile(orbifold, arrangement)});
      } while (std::next_permutation(orders, text.end()));
    }
    return result;
  }();
  return all;
}

std::string trace(const Case& c) {
  std::string text = c.orbifold.signature + ", arrangement";
  for (const int mark : c.arrangement) text += " " + std::to_string(mark);
  return text;
}

template <typename Check>
void for_every_tile(const Check& check) {
  for (const Case& c : cases()) {
    SCOPED_TRACE(trace(c));
    check(c);
    if (testing::Test::HasFailure()) return;  // the first is enough
  }
}

std::vector<Isometry> generators(const Tile& tile) {
  std::vector<Isometry> result;
  for (const TileSide& side : tile.sides) result.push_back(side.transform);
  return result;
}

int size(const Tile& tile) { return static_cast<int>(tile.sides.size()); }

/// The side before side k around the tile.
const TileSide& before(const Tile& tile, int k) { return tile.sides[(k + size(tile) - 1) % size(tile)]; }

/// The unit tangent with which a side arrives at its end.
Vector3 arrival(const TileSide& side) {
  if (side.space == Space::plane()) return side.direction;
  return -std::sin(side.length) * side.start + std::cos(side.length) * side.direction;
}

/// From the side that leaves the corner counterclockwise to the side that arrives, through the tile, in (0, 2
/// pi).
double interior_angle(const Tile& tile, int k) {
  const Vector3 leaving = tile.sides[k].direction, back = -arrival(before(tile, k));
  const double angle = std::atan2(tile.sides[k].start.dot(leaving.cross(back)), leaving.dot(back));
  return angle > 0 ? angle : angle + 2 * pi;
}

/// Sums over the sides of a fan around a point inside, in polar coordinates about it: the area, and the
/// integral of the position.
struct Integral {
  double area = 0;
  Vector3 position = Vector3::Zero();
};

Integral integrate(const Tile& tile, double offset, int steps) {
  const TileSide& first = tile.sides.front();
  const Vector3 apex = (first.point(first.length / 2) + offset * first.line()).normalized();
  const Vector3 e1 = apex.unitOrthogonal(), e2 = apex.cross(e1);
  const auto angle = [&](const Vector3& p) { return std::atan2(p.dot(e2), p.dot(e1)); };
  Integral result;
  for (const TileSide& side : tile.sides) {
    for (int i = 0; i < steps; ++i) {
      const Vector3 here = side.point(side.length * i / steps),
                    next = side.point(side.length * (i + 1) / steps);
      const Vector3 middle = side.point(side.length * (i + 0.5) / steps);
      const double sector = std::remainder(angle(next) - angle(here), 2 * pi);
      const Vector3 along = (middle - middle.dot(apex) * apex).normalized();
      const double R = std::atan2(middle.cross(apex).norm(), middle.dot(apex));
      result.area += sector * (1 - std::cos(R));
      result.position +=
          sector * (0.5 * std::pow(std::sin(R), 2) * apex + (R / 2 - std::sin(2 * R) / 4) * along);
    }
  }
  return result;
}

// --------------------------------------------------------------------------------------------- the polygon

TEST(Tile, SidesAreUnitSpeedGeodesics) {
  for_every_tile([](const Case& c) {
    const Space space = c.orbifold.space;
    for (const TileSide& side : c.tile.sides) {
      EXPECT_EQ(side.space, space);
      EXPECT_LE(space.defect(side.start), rounding);
      EXPECT_NEAR(space.norm(side.direction), 1, rounding);
      EXPECT_NEAR((space.tangent(side.start, side.direction) - side.direction).norm(), 0, rounding);
      EXPECT_GT(side.length, 0);
      if (space == Space::sphere()) {
        EXPECT_LE(side.length, pi);
      }
      EXPECT_LE(space.defect(side.point(side.length / 3)), rounding);
      EXPECT_NEAR(space.distance(side.start, side.point(side.length / 3)), side.length / 3, rounding);
      EXPECT_NEAR((side.point(0) - side.start).norm(), 0, rounding);
      EXPECT_NEAR(side.line().dot(side.point(side.length / 3)), 0, rounding);
    }
  });
}

TEST(Tile, EverySideBeginsWhereTheOneBeforeEnds) {
  for_every_tile([](const Case& c) {
    for (int k = 0; k < size(c.tile); ++k) {
      const TileSide& previous = before(c.tile, k);
      EXPECT_NEAR((previous.point(previous.length) - c.tile.sides[k].start).norm(), 0, rounding);
    }
  });
}

TEST(Tile, LiesOnTheLeftOfEverySide) {
  for_every_tile([](const Case& c) {
    const Vector3 centroid = c.tile.centroid();
    for (int k = 0; k < size(c.tile); ++k) {
      const TileSide& side = c.tile.sides[k];
      EXPECT_LE(interior_angle(c.tile, k), pi + rounding) << "the tile is not convex";
      EXPECT_GT(side.line().dot(centroid), 0);
      for (const TileSide& other : c.tile.sides)
        EXPECT_GE(side.line().dot(other.point(0.4 * other.length)), -rounding);
    }
  });
}

TEST(Tile, CornersMeetTheMarksInTheOrderOfTheArrangement) {
  for_every_tile([](const Case& c) {
    std::vector<int> met;
    for (const TileSide& side : c.tile.sides)
      if (std::find(met.begin(), met.end(), side.mark) == met.end()) met.push_back(side.mark);
    EXPECT_EQ(met, c.arrangement);
  });
}

TEST(Tile, AnglesAroundAMarkAddUpToItsOrdersShare) {
  for_every_tile([](const Case& c) {
    std::vector<double> angle(c.arrangement.size(), 0.0);
    for (int k = 0; k < size(c.tile); ++k) angle[c.tile.sides[k].mark] += interior_angle(c.tile, k);
    for (std::size_t m = 0; m < angle.size(); ++m) {
      const Mark mark = mark_at(c.orbifold, m);
      EXPECT_NEAR(angle[m], (mark.kind == ConeKind::rotation ? 2 : 1) * pi / mark.order(), rounding)
          << "mark " << m;
    }
  });
}

TEST(Tile, OnlyTheEndOfACutToTheMirrorOfACornerSlides) {
  for_every_tile([](const Case& c) {
    const int marks = static_cast<int>(c.orbifold.marks.size());
    for (const TileSide& side : c.tile.sides) EXPECT_EQ(side.slides, side.mark >= marks && marks > 1);
  });
}

TEST(Tile, CopiesOfAMarkShareItsAngleEquallyInKites) {
  for_every_tile([](const Case& c) {
    for (int k = 0; k < size(c.tile); ++k) {
      for (int l = 0; l < k; ++l) {
        if (c.tile.sides[k].mark != c.tile.sides[l].mark) continue;
        EXPECT_NEAR(interior_angle(c.tile, k), interior_angle(c.tile, l), rounding);
      }
    }
  });
}

TEST(Tile, AreaIsTheSpheresOverTheGroupOrderAndAngleExcessInThePlaneZero) {
  for_every_tile([](const Case& c) {
    const int order = c.orbifold.group_order;
    double excess = 2 * pi;  // Gauss-Bonnet: the area is 2 pi less the exterior angles
    for (int k = 0; k < size(c.tile); ++k) excess -= pi - interior_angle(c.tile, k);
    EXPECT_NEAR(excess, order > 0 ? 4 * pi / order : 0, rounding);
  });
}

TEST(Tile, CentroidIsTheDirectionOfTheIntegralOfThePosition) {
  for_every_tile([](const Case& c) {
    if (!is_first(c.arrangement, c.orbifold) || c.orbifold.space != Space::sphere()) return;
    const double area = 4 * pi / c.orbifold.group_order;
    const Integral integral = integrate(c.tile, area / 20, 2000);
    EXPECT_NEAR(integral.area, area, 1e-3 * area);
    EXPECT_NEAR((integral.position.normalized() - c.tile.centroid()).norm(), 0, 1e-4);
    EXPECT_NEAR(c.tile.centroid().norm(), 1, rounding);
  });
}

// ---------------------------------------------------------------------------------------------- the gluing

TEST(Tile, TransformsCarryThePartnerSidePointByPoint) {
  for_every_tile([](const Case& c) {
    for (const TileSide& side : c.tile.sides) {
      const TileSide& partner = c.tile.sides[side.partner];
      EXPECT_NEAR(side.length, partner.length, rounding);
      for (int i = 0; i <= 8; ++i) {
        const double s = side.length * i / 8;
        const Vector3 image = side.transform * partner.point(side.partner_reverses() ? side.length - s : s);
        EXPECT_NEAR((side.point(s) - image).norm(), 0, rounding);
      }
    }
  });
}

TEST(Tile, GluedSidesJoinTheSameMarks) {
  for_every_tile([](const Case& c) {
    const auto end_mark = [&](int k) { return c.tile.sides[(k + 1) % size(c.tile)].mark; };
    for (int k = 0; k < size(c.tile); ++k) {
      const int partner = c.tile.sides[k].partner;
      if (!c.tile.sides[k].partner_reverses()) continue;
      EXPECT_EQ(c.tile.sides[k].mark, end_mark(partner));
      EXPECT_EQ(end_mark(k), c.tile.sides[partner].mark);
    }
  });
}

TEST(Tile, PartnerOfThePartnerIsTheSideWithTheInverseTransform) {
  for_every_tile([](const Case& c) {
    for (int k = 0; k < size(c.tile); ++k) {
      const TileSide& side = c.tile.sides[k];
      ASSERT_GE(side.partner, 0);
      ASSERT_LT(side.partner, size(c.tile));
      const TileSide& partner = c.tile.sides[side.partner];
      EXPECT_EQ(partner.partner, k);
      EXPECT_NEAR((side.transform * partner.transform).difference({}), 0, rounding);
      EXPECT_NEAR(side.transform.inverse().difference(partner.transform), 0, rounding);
    }
  });
}

TEST(Tile, TransformsAreReflectionsAtMirrorsAndTurnTheTileOverWhereTheSurfaceHasNoOrientation) {
  for_every_tile([](const Case& c) {
    int mirrors = 0;
    for (int k = 0; k < size(c.tile); ++k) {
      const TileSide& side = c.tile.sides[k];
      const bool mirror = side.partner == k;
      mirrors += mirror;
      EXPECT_LE(c.orbifold.space.isometry_defect(side.transform.matrix()), rounding);
      EXPECT_EQ(side.transform.reverses_orientation(), mirror || c.orbifold.symbol.cross);
      if (mirror) {
        const Vector3 inside = c.tile.centroid();
        EXPECT_NEAR(side.line().dot(side.transform * inside), -side.line().dot(inside), rounding);
        EXPECT_NEAR((side.transform * side.transform).difference({}), 0, rounding);
      }
    }
    EXPECT_EQ(mirrors, c.mirrors);
  });
}

TEST(Tile, TransformsTakeTheTileOffItself) {
  for_every_tile([](const Case& c) {
    const Vector3 centroid = c.tile.centroid();
    for (const TileSide& side : c.tile.sides) {
      // The neighbour across a side lies on its other side.
      EXPECT_LT(side.line().dot(side.transform * centroid), 0);
    }
  });
}

TEST(Tile, TransformsGenerateTheGroup) {
  for_every_tile([](const Case& c) {
    if (!is_first(c.arrangement, c.orbifold) || c.orbifold.group_order == 0) return;
    const SymmetryGroup group(c.orbifold.space, generators(c.tile), 2 * c.orbifold.group_order);
    EXPECT_EQ(group.order(), c.orbifold.group_order);
  });
}

TEST(Tile, OnlyTwoConesOnASphereOrOneAloneLeaveARotationFree) {
  for_every_tile([](const Case& c) {
    const std::size_t marks = c.orbifold.marks.size();
    const bool expected = (c.orbifold.topology == Topology::sphere && marks == 2) ||
                          (c.orbifold.inner_marks == 1 && marks == 1);
    EXPECT_EQ(is_free_to_rotate(c.tile), expected);
    if (!expected) return;
    const Isometry turn = Space::sphere().rotation(Space::origin(), 0.7);
    for (const TileSide& side : c.tile.sides)
      EXPECT_NEAR((turn * side.transform).difference(side.transform * turn), 0, rounding);
  });
}

TEST(Tile, LargestOrdersStillCloseUp) {
  for (const std::string text : {"2,2,20000", "2,20000,2", "20000,20000", "*2,2,20000", "*20000,20000",
                                 "2*20000", "20000*", "20000x"}) {
    SCOPED_TRACE(text);
    const Target orbifold = parse_orbifold(text);
    const Tile tile = basic_tile(orbifold, arrangements(orbifold).front());
    for (int k = 0; k < size(tile); ++k) {
      const TileSide& side = tile.sides[k];
      const TileSide& previous = before(tile, k);
      const TileSide& partner = tile.sides[side.partner];
      const double s = side.length / 3, t = side.partner_reverses() ? side.length - s : s;
      EXPECT_NEAR((previous.point(previous.length) - side.start).norm(), 0, 1e-10);
      EXPECT_NEAR((side.point(s) - side.transform * partner.point(t)).norm(), 0, 1e-10);
      EXPECT_GT(side.line().dot(tile.centroid()), 0);
    }
  }
}

// ------------------------------------------------------------------------------------- the canonical frame

/// Elements of the group, in the plane those near to the tile.
std::vector<Isometry> elements(const Target& orbifold) { return group_of(orbifold, 400).elements(); }

/// The arrangements that a cut of one and the same mesh may have: where all marks lie on the boundary, those
/// that go around in the same sequence, and the other way around as well, for a mesh turned over.
bool is_of_the_same_mesh(const Target& orbifold, const std::vector<int>& arrangement) {
  const int marks = static_cast<int>(orbifold.marks.size());
  if (orbifold.inner_marks > 0 || marks < 4) return true;
  for (int k = 0; k < marks; ++k) {
    const int step = std::abs(arrangement[k] - arrangement[(k + 1) % marks]);
    if (step != 1 && step != marks - 1) return false;
  }
  return true;
}

/// Points of the tile, its border left out.
std::vector<Vector3> points_inside(const Tile& tile, int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0.05, 1);
  std::vector<Vector3> points;
  for (int k = 0; k < count; ++k) {
    Vector3 sum = uniform(random) * tile.centroid();
    for (const TileSide& side : tile.sides)
      sum += uniform(random) * side.start + uniform(random) * side.point(side.length / 2);
    points.push_back(tile.space().retract(sum));
  }
  return points;
}

bool holds(const Tile& tile, const Vector3& point) {
  return std::all_of(tile.sides.begin(), tile.sides.end(),
                     [&](const TileSide& side) { return side.line().dot(point) > 0; });
}

template <typename Check>
void for_every_tile_of_a_small_group(const Check& check) {
  for_every_tile([&](const Case& c) {
    if (c.orbifold.group_order <= 120 && is_of_the_same_mesh(c.orbifold, c.arrangement)) check(c);
  });
}

TEST(CanonicalTile, TheGroupIsTheSameForEveryArrangement) {
  for_every_tile_of_a_small_group([](const Case& c) {
    const SymmetryGroup group = group_of(c.orbifold, 400);
    for (const Isometry& generator : generators(c.tile)) EXPECT_GE(group.find(generator), 0);
    // and these generate no less
    const SymmetryGroup generated =
        SymmetryGroup::nearest_elements(c.orbifold.space, generators(c.tile), c.tile.centroid(), 400);
    for (const Isometry& generator : generators(basic_tile(c.orbifold, first_arrangement(c.orbifold))))
      EXPECT_GE(generated.find(generator), 0);
  });
}

TEST(CanonicalTile, PointsOfOneTileLieInTheCopiesOfAnyOtherExactlyOnce) {
  for_every_tile_of_a_small_group([](const Case& c) {
    const Tile first = basic_tile(c.orbifold, first_arrangement(c.orbifold));
    const std::vector<Isometry> group = elements(c.orbifold);
    for (const Vector3& point : points_inside(c.tile, 20)) {
      EXPECT_TRUE(holds(c.tile, point));
      const auto in_first = [&](const Isometry& g) { return holds(first, g * point); };
      EXPECT_EQ(std::count_if(group.begin(), group.end(), in_first), 1);
    }
  });
}

/// Does an element of the group take p to q?
bool same_in_the_quotient(const std::vector<Isometry>& group, const Vector3& p, const Vector3& q) {
  return std::any_of(group.begin(), group.end(),
                     [&](const Isometry& g) { return (g * p - q).norm() < 1e-9; });
}

TEST(CanonicalTile, EveryMarkIsTheSamePointOfTheQuotientForEveryArrangement) {
  for_every_tile_of_a_small_group([](const Case& c) {
    const Tile first = basic_tile(c.orbifold, first_arrangement(c.orbifold));
    const std::vector<Isometry> group = elements(c.orbifold);
    for (const TileSide& side : c.tile.sides)
      for (const TileSide& other : first.sides) {
        if (side.mark != other.mark) continue;
        EXPECT_TRUE(same_in_the_quotient(group, side.start, other.start)) << "mark " << side.mark;
      }
  });
}

TEST(CanonicalTile, MarkZeroIsAtTheOriginAndMarkOneInTheDirectionOfX) {
  for_every_tile_of_a_small_group([](const Case& c) {
    const std::vector<Isometry> group = elements(c.orbifold);
    for (const TileSide& side : c.tile.sides) {
      if (side.mark == 0) {
        EXPECT_TRUE(same_in_the_quotient(group, side.start, Space::origin()));
      }
      if (side.mark == 1 && !c.orbifold.is_free_to_rotate) {
        EXPECT_TRUE(std::any_of(group.begin(), group.end(), [&](const Isometry& g) {
          const Vector3 image = g * side.start;
          return std::abs(image.y()) < 1e-9 && image.x() > -1e-9;
        }));
      }
    }
  });
}

// ------------------------------------------------------------------------------------- columns of the table

// z -> z^N is their quotient: N of the elements that keep orientations are there, all about (0, 0, 1).
TEST(Families, ThoseOfOneAxisHaveNoRotationAboutAnother) {
  int count = 0;
  for (const test::SphericalOrbifold& orbifold : test::spherical_orbifolds()) {
    const Target target = parse_orbifold(symbol(orbifold));
    if (!find_family(target.symbol)->has_one_axis) continue;
    ++count;
    int rotations = 0;
    const SymmetryGroup group = group_of(target);
    for (const Isometry& g : group.elements()) {
      if (g.reverses_orientation()) continue;
      ++rotations;
      EXPECT_LE((g * Space::origin() - Space::origin()).norm(), 1e-12) << target.signature;
    }
    EXPECT_EQ(rotations, target.marks[0].order()) << target.signature;
  }
  EXPECT_EQ(count, 18) << "NN, *NN and N*, for six orders each";
}

TEST(Families, ThreeHalfTurnsAreThoseOfTheStandardTargets) {
  for (const Topology topology : {Topology::sphere, Topology::disk})
    EXPECT_TRUE(is_of_three_half_turns(standard_target(topology).symbol));
  for (const char* signature : {"1", "*", "1x", "22", "*22", "223", "*223", "2*2", "2*", "332", "2222"})
    EXPECT_FALSE(is_of_three_half_turns(parse_orbifold(signature).symbol)) << signature;
}

// ------------------------------------------------------------------------------------------------- refusals

TEST(Tile, ArrangementsThatAreNoPermutationsAreRefused) {
  const auto refusal = [](const std::string& signature, const std::vector<int>& arrangement) -> std::string {
    try {
      basic_tile(parse_orbifold(signature), arrangement);
      return {};
    } catch (const ArgumentError& error) {
      return error.what();
    }
  };
  const std::string no_permutation = "the arrangement of the marks is no permutation of them";
  EXPECT_EQ(refusal("532", {0, 1, 1}), no_permutation);
  EXPECT_EQ(refusal("532", {0, 1, 3}), no_permutation);
  EXPECT_EQ(refusal("532", {0, -1, 1}), no_permutation);
  EXPECT_EQ(refusal("22", {0, 1, 2}), no_permutation);
  EXPECT_EQ(refusal("532", {0, 1}), "the arrangement leaves marks out");
  EXPECT_EQ(refusal("532", {}), "the arrangement leaves marks out");
  EXPECT_EQ(refusal("5*", {0}), "the arrangement leaves marks out");
  EXPECT_EQ(refusal("5*", {0, 2}), no_permutation);
  EXPECT_EQ(refusal("3*2", {0, 3, 1}), no_permutation);
  const std::string elsewhere = "the arrangement does not begin with the cone and the end of the cut";
  EXPECT_EQ(refusal("3*2", {1, 2, 0}), elsewhere);
  EXPECT_EQ(refusal("3*2", {0, 1, 2}), elsewhere);
  EXPECT_EQ(refusal("5*", {1, 0}), elsewhere);
}

}  // namespace
}  // namespace orbitutte::tile_test
