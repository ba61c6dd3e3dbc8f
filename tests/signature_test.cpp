// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/signature.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>
#include <vector>

#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/target_words.h"
#include "planar_families.h"
#include "spherical_families.h"

namespace orbitutte::signature_test {
namespace {

using test::SphericalOrbifold;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string euclidean =
    " is a Euclidean orbifold for which there is no tile; of those there are 333, 442, 632, 2222, *333, "
    "*442, *632 and *2222";
const std::string hyperbolic =
    " is a hyperbolic orbifold with a cross; of hyperbolic ones there are those of spheres and disks";
const std::string bad =
    " is not an orbifold of the sphere: one order alone, or two different ones, close up no tiling (a "
    "teardrop or spindle)";
const std::string order_one = " has an order of 1, which marks nothing; orders are 2 or more";
const std::string order_zero = " has an order of 0; orders are 2 or more";
const std::string no_symbol =
    " is no Conway symbol: it may hold digits, commas, one '*' and one 'x'; see 'orbitutte types'";
const std::string too_many_signs = " has more than one star or cross; orbifolds with two have no tile here";
const std::string after_cross = " has orders after the cross; rotations come before it";
const std::string empty_place = " has an empty place between commas; give every order once";

/// The sentence with which a text is refused; empty where it is accepted.
std::string refusal_of_symbol(const std::string& text) {
  try {
    parse_orbifold(text);
    return {};
  } catch (const ArgumentError& error) {
    return error.what();
  }
}

void expect_refused(const std::vector<std::string>& texts, const std::string& reason) {
  for (const std::string& text : texts) EXPECT_EQ(refusal_of_symbol(text), "'" + text + "'" + reason);
}

std::vector<int> orders(const Target& orbifold) {
  std::vector<int> result;
  for (const Mark& mark : orbifold.marks) result.push_back(mark.order());
  return result;
}

/// Conway's price list: a sphere costs 2, every sign takes its share away.
double euler_characteristic(const ConwaySymbol& symbol) {
  double chi = 2;
  for (const int n : symbol.rotations) chi -= 1 - 1.0 / n;
  for (const int m : symbol.corners) chi -= (1 - 1.0 / m) / 2;
  return chi - symbol.star - symbol.cross;
}

/// Do the orders make one of the five closed families, or behind a star one of the five with mirrors only?
bool spherical(std::vector<int> n) {
  if (n.empty()) return true;  // nothing but a mirror, or nothing at all
  std::sort(n.begin(), n.end());
  if (n.size() == 2) return n[0] >= 2 && n[0] == n[1];
  if (n.size() != 3 || n[0] != 2) return false;
  return n[1] == 2 || (n[1] == 3 && n[2] <= 5);
}

bool spherical(const ConwaySymbol& symbol) {
  if (symbol.cross) return !symbol.star && symbol.corners.empty() && symbol.rotations.size() == 1;
  if (!symbol.star) return spherical(symbol.rotations);
  if (symbol.rotations.empty()) return spherical(symbol.corners);
  if (symbol.rotations.size() > 1 || symbol.corners.size() > 1 || symbol.rotations[0] < 2) return false;
  if (symbol.corners.empty()) return true;  // N*
  return symbol.corners[0] >= 2 &&
         (symbol.rotations[0] == 2 || (symbol.rotations[0] == 3 && symbol.corners[0] == 2));
}

/// Are these the orders of one of the four families of the plane, with or without mirrors?
bool planar(std::vector<int> n) {
  std::sort(n.begin(), n.end());
  for (const auto& orders : {std::vector<int>{3, 3, 3}, {2, 4, 4}, {2, 3, 6}, {2, 2, 2, 2}})
    if (n == orders) return true;
  return false;
}

std::vector<std::string> planar_families() {
  std::vector<std::string> all = test::planar_signatures();
  for (const std::string& signature : test::free_planar_signatures()) all.push_back(signature);
  return all;
}

bool planar(const ConwaySymbol& symbol) {
  if (symbol.cross) return false;
  return symbol.star ? symbol.rotations.empty() && planar(symbol.corners) : planar(symbol.rotations);
}

// ------------------------------------------------------------------------------------------- what is read

TEST(Signature, EveryFamilyHasItsGroupOrderTopologyAndMarks) {
  for (const SphericalOrbifold& expected : test::arranged_orbifolds()) {
    const std::string text = test::symbol(expected);
    SCOPED_TRACE(text);
    const Target orbifold = parse_orbifold(text);
    EXPECT_EQ(orbifold.signature, text);
    EXPECT_EQ(orbifold.group_order, expected.group_order);
    EXPECT_EQ(orbifold.space, Space::sphere());
    EXPECT_EQ(orbifold.topology, expected.topology());
    EXPECT_EQ(orders(orbifold), expected.orders);
    EXPECT_EQ(orbifold.inner_marks, expected.inside);
    for (int k = 0; k < static_cast<int>(orbifold.marks.size()); ++k)
      EXPECT_EQ(orbifold.marks[k].kind, k < expected.inside ? ConeKind::rotation : ConeKind::corner);
  }
}

TEST(Signature, EuclideanOrbifoldsAreRowsLikeTheOthers) {
  for (const std::string text : {"333", "442", "244", "424", "632", "236", "326", "2222", "*333", "*442",
                                 "*244", "*632", "*263", "*2222"}) {
    SCOPED_TRACE(text);
    const Target orbifold = parse_orbifold(text);
    EXPECT_EQ(orbifold.signature, text);
    EXPECT_EQ(orbifold.group_order, 0) << "it is infinite";
    EXPECT_EQ(orbifold.space, Space::plane());
    const bool star = text[0] == '*';
    EXPECT_EQ(orbifold.topology, star ? Topology::disk : Topology::sphere);
    EXPECT_EQ(orbifold.inner_marks, star ? 0 : static_cast<int>(text.size()));
    std::vector<int> expected;
    for (const char digit : text.substr(star)) expected.push_back(digit - '0');
    EXPECT_EQ(orders(orbifold), expected);
    EXPECT_FALSE(orbifold.is_free_to_rotate);
    EXPECT_EQ(orbifold.has_free_tile, orbifold.marks.size() == 4) << "three marks leave no shape open";
  }
  EXPECT_EQ(parse_orbifold("2,2,2,2").signature, "2222");
  EXPECT_EQ(parse_orbifold("*3,3,3").signature, "*333");
}

TEST(Signature, MarksHaveTheAnglesOfTheirOrders) {
  for (const int n : {1, 2, 3, 5, 7, 12, 97, 1000, 19999, 20000}) {
    const double pi = std::numbers::pi;
    EXPECT_NEAR(Mark::of_order(n, ConeKind::rotation).angle, 2 * pi / n, 1e-15);
    EXPECT_NEAR(Mark::of_order(n, ConeKind::corner).angle, pi / n, 1e-15);
    for (const ConeKind kind : {ConeKind::rotation, ConeKind::corner})
      EXPECT_EQ(Mark::of_order(n, kind).order(), n);
  }
  EXPECT_EQ(Mark::of_order(7, ConeKind::fixed).order(), 1);
  EXPECT_EQ((Mark{2.0, ConeKind::rotation}).order(), 0) << "no order has this angle";
  EXPECT_EQ((Mark{0.0, ConeKind::corner}).order(), 0);
  EXPECT_EQ((Mark{-1.0, ConeKind::rotation}).order(), 0);
  EXPECT_EQ((Mark{8.0, ConeKind::rotation}).order(), 0) << "more than a full turn";
}

TEST(Signature, OnlyTwoConesOneAloneOrNoneLeaveARotationFree) {
  for (const SphericalOrbifold& expected : test::arranged_orbifolds()) {
    const std::set<std::string> free = {"NN", "N*", "Nx", "1", "*"};
    EXPECT_EQ(parse_orbifold(test::symbol(expected)).is_free_to_rotate, free.count(expected.family) > 0)
        << test::symbol(expected);
  }
}

TEST(Signature, TheSymbolKeepsTheOrdersOnTheirSideOfTheStar) {
  EXPECT_THAT(parse_orbifold("253").symbol.rotations, ElementsAre(2, 5, 3));
  EXPECT_THAT(parse_orbifold("253").symbol.corners, IsEmpty());
  EXPECT_THAT(parse_orbifold("*253").symbol.corners, ElementsAre(2, 5, 3));
  EXPECT_THAT(parse_orbifold("*253").symbol.rotations, IsEmpty());
  EXPECT_TRUE(parse_orbifold("*253").symbol.star);
  EXPECT_FALSE(parse_orbifold("253").symbol.star);
  EXPECT_FALSE(parse_orbifold("*253").symbol.cross);
  EXPECT_TRUE(parse_orbifold("3x").symbol.cross);
}

TEST(Signature, CommasMayStandBetweenSingleDigits) {
  for (const SphericalOrbifold& expected : test::arranged_orbifolds()) {
    const std::string text = test::symbol(expected, true);
    EXPECT_EQ(parse_orbifold(text).signature, test::symbol(expected)) << text;
  }
}

TEST(Signature, CanonicalTextIsReadAsTheSameOrbifold) {
  for (const SphericalOrbifold& expected : test::arranged_orbifolds()) {
    const Target once = parse_orbifold(test::symbol(expected, true));
    const Target twice = parse_orbifold(once.signature);
    EXPECT_EQ(twice.signature, once.signature);
    EXPECT_EQ(once.symbol.text(), once.signature);
    EXPECT_EQ(twice.group_order, once.group_order);
    EXPECT_EQ(orders(twice), orders(once));
  }
}

TEST(Signature, FamiliesAreListedOnceEach) {
  std::set<std::string> listed, expected;
  for (const FamilyDescription& family : families()) {
    EXPECT_TRUE(listed.insert(family.family).second) << family.family;
    EXPECT_FALSE(family.group_order.empty());
    EXPECT_FALSE(family.marked_points.empty());
  }
  for (const SphericalOrbifold& orbifold : test::spherical_orbifolds()) expected.insert(orbifold.family);
  for (const std::string& family : planar_families()) expected.insert(family);
  EXPECT_EQ(listed, expected);
  for (const FamilyDescription& family : families()) {
    const std::vector<std::string> planar = planar_families();
    const bool flat = std::count(planar.begin(), planar.end(), family.family) > 0;
    EXPECT_EQ(family.space, flat ? Space::plane() : Space::sphere()) << family.family;
    EXPECT_EQ(family.group_order == "infinite", flat) << family.family;
  }
}

TEST(Signature, TheLargestOrderIsAcceptedAndTheNextRefused) {
  EXPECT_EQ(parse_orbifold("2,2,20000").group_order, 40000);
  EXPECT_EQ(parse_orbifold("*2,2,20000").group_order, 80000);
  EXPECT_EQ(parse_orbifold("2*20000").group_order, 80000);
  EXPECT_EQ(parse_orbifold("20000*").group_order, 40000);
  EXPECT_EQ(parse_orbifold("20000x").group_order, 40000);
  expect_refused(
      {"2,2,20001", "2,2,99999999999999999999", "2230000", "30000,30000", "*30000", "2*30000", "30000*"},
      " has an order above 20000, the largest that is supported");
}

// -------------------------------------------------------------------------------------- what is refused

TEST(Signature, EuclideanOrbifoldsWithoutATileAreRefused) {
  expect_refused({"3*3", "4*2", "2,2*", "2*2,2", "2,2x"}, euclidean);
}

TEST(Signature, HyperbolicOrbifoldsWithACrossAreRefused) { expect_refused({"2,3x", "2,2,2x"}, hyperbolic); }

TEST(Signature, HyperbolicOrbifoldsOfDisksAreReadAndWrittenWithCommas) {
  for (const auto& [text, canonical] :
       {std::pair("*7,3,2", "*7,3,2"), std::pair("*555", "*5,5,5"), std::pair("3*4", "3*4"),
        std::pair("5*2", "5*2"), std::pair("2*2,3", "2*2,3"), std::pair("*2,2,2,2,2", "*2,2,2,2,2"),
        std::pair("2,3*", "2,3*"), std::pair("3*12,", "3*12,"), std::pair("2,3*2,2", "2,3*2,2")}) {
    const Target target = parse_orbifold(text);
    EXPECT_EQ(target.signature, canonical);
    EXPECT_EQ(parse_orbifold(target.signature).signature, canonical);
    EXPECT_EQ(target.space, Space::hyperbolic_plane());
    EXPECT_EQ(target.topology, Topology::disk);
    EXPECT_EQ(target.inner_marks, static_cast<int>(target.symbol.rotations.size()));
    EXPECT_TRUE(target.has_free_tile);
  }
}

TEST(Signature, HyperbolicOrbifoldsOfSpheresAreReadAndWrittenWithCommas) {
  for (const auto& [text, canonical] :
       {std::pair("237", "2,3,7"), std::pair("732", "7,3,2"), std::pair("334", "3,3,4"),
        std::pair("9,9,9", "9,9,9"), std::pair("2,2,2,2,2", "2,2,2,2,2"), std::pair("2,2,2,3", "2,2,2,3")}) {
    const Target target = parse_orbifold(text);
    EXPECT_EQ(target.signature, canonical);
    EXPECT_EQ(parse_orbifold(target.signature).signature, canonical);
    EXPECT_EQ(target.space, Space::hyperbolic_plane());
    EXPECT_TRUE(target.has_free_tile);
    EXPECT_EQ(target.group_order, 0);
  }
}

TEST(Signature, ManyLargeOrdersAreHyperbolicWithoutOverflow) {
  EXPECT_EQ(parse_orbifold("19997,19993,19991,19979,19973,19963,19961").space, Space::hyperbolic_plane());
  EXPECT_EQ(parse_orbifold("16384,16384,16384,16384,16384,16384").space, Space::hyperbolic_plane());
  for (const char* text :
       {"*19997,19993,19991,19979,19973,19963,19961", "19997,19993,19991*19979,19973,19963"})
    EXPECT_EQ(parse_orbifold(text).space, Space::hyperbolic_plane());
}

TEST(Signature, TeardropsAndSpindlesAreRefused) {
  expect_refused({"5", "9", "23", "73", "*5", "*23", "*94", "2,12", "12,2", "*12,2", "12,", "*12,"}, bad);
}

TEST(Signature, OrdersOfZeroAreRefused) {
  expect_refused({"0", "05", "*0", "*05", "2,2,0", "0,0", "*0,2,2", "0*", "0x", "3*0"}, order_zero);
}

TEST(Signature, OrdersOfOneAreRefused) {
  expect_refused({"11", "12", "*1", "*11", "1,1", "1,1,1", "*1,1", "1,2,2", "221", "*221", "1,1*", "5*1",
                  "2*1,2", "1,1x", "1,2x"},
                 order_one);
}

TEST(Signature, TheEmptyTextIsRefused) {
  EXPECT_EQ(refusal_of_symbol(""), "the symbol is empty; see 'orbitutte types'");
}

TEST(Signature, NothingIsMarkedOnTheWholeSphereAndTheHemisphere) {
  for (const char* text : {"1", "sphere", "*", "1*", "hemisphere"}) {
    const Target target = parse_orbifold(text);
    EXPECT_TRUE(target.marks.empty()) << text;
    const bool is_disk = target.topology == Topology::disk;
    EXPECT_EQ(target.signature, is_disk ? "*" : "1") << text;
    EXPECT_EQ(target.group_order, is_disk ? 2 : 1) << text;
  }
}

TEST(Signature, OtherCharactersAreNoSymbol) {
  expect_refused({"532 ", " 532", "5 3 2", "-532", "+22", "2.2", "2;2", "o", "O", "icosahedral", "C5", "5\t3",
                  "\xc3", "\xc3\xa4", "5\xc3", "polygon", "*532!"},
                 no_symbol);
}

TEST(Signature, TwoStarsOrCrossesAreRefused) {
  expect_refused({"**", "xx", "*x", "x*", "2*2*2", "2*3x", "5xx", "*532*", "5\xc3\x97\xc3\x97", "5x\xc3\x97"},
                 too_many_signs);
}

TEST(Signature, TheLetterThatStandsForAnyOrderAsksForANumber) {
  for (const std::string text : {"N*", "22N", "*NN", "Nx"})
    EXPECT_THAT(refusal_of_symbol(text), HasSubstr("put a number for it")) << text;
}

TEST(TargetWords, GroupsAreFiniteOnTheSphereAlone) {
  const auto cones = [](double angle, int count) {
    return cone_target(Topology::sphere, std::vector<Mark>(count, {angle, ConeKind::rotation}));
  };
  const double pi = std::numbers::pi;
  EXPECT_EQ(group_text(parse_orbifold("432")), "group of order 24");
  EXPECT_EQ(group_text(parse_orbifold("442")), "infinite group");
  EXPECT_EQ(group_text(parse_orbifold("7,3,2")), "infinite group");
  EXPECT_EQ(group_text(cones(pi, 3)), "finite group");
  EXPECT_EQ(group_text(cones(pi, 4)), "infinite group");
  EXPECT_EQ(group_text(cones(1.1 * pi, 3)), "no group");
}

TEST(Signature, ATopologyHasAStandardTarget) {
  for (const Topology topology : {Topology::sphere, Topology::disk, Topology::projective_plane}) {
    EXPECT_EQ(standard_target(topology).topology, topology);
    EXPECT_FALSE(standard_target(topology).marks.empty());
  }
}

TEST(Signature, OrdersAfterTheCrossAreRefused) {
  expect_refused({"x5", "5x3", "x2,2", "5x,",
                  "5\xc3\x97"
                  "3"},
                 after_cross);
}

TEST(Signature, MisplacedCommasAreRefused) {
  expect_refused({",", ",,", ",5", "5,,3", "5,3,,2", ",532", "*,5", "*,", ",*", "2,,*", "*2,2,,", "2*,"},
                 empty_place);
}

TEST(Signature, TooManyDigitsWithoutCommasAreRefused) {
  expect_refused({"2222222222222", "*2222222222222"},
                 " has too many digits without commas; separate the orders by commas");
}

TEST(Signature, ALoneOrderOfTwoDigitsOrMoreNeedsNoComma) {
  for (const auto& [text, canonical] :
       {std::pair("2*12", "2*12"), std::pair("12*", "12*"), std::pair("12,*", "12*"),
        std::pair("22,*", "22,*"), std::pair("2*22,", "2*22,"), std::pair("2,*12", "2*12"),
        std::pair("11*", "11*"), std::pair("10*", "10*"), std::pair("2*10", "2*10"),
        std::pair("2*11", "2*11")})
    EXPECT_EQ(parse_orbifold(text).signature, canonical) << text;
}

TEST(Signature, OrdersOfMixedFamiliesDoNotChangeSides) {
  for (const char* text : {"2*", "3*2", "2*3"}) EXPECT_EQ(refusal_of_symbol(text), "");
  expect_refused({"4*2", "3*3"}, euclidean);
  expect_refused({"*2", "*3"}, bad);
}

TEST(Signature, TheCrossHasManyForms) {
  for (const auto& [text, canonical] :
       {std::pair("x", "1x"), std::pair("X", "1x"), std::pair("1x", "1x"), std::pair("3\xc3\x97", "3x"),
        std::pair("\xc3\x97", "1x"), std::pair("12x", "12x"), std::pair("22,x", "22,x"),
        std::pair("11x", "11x"), std::pair("5X", "5x")})
    EXPECT_EQ(parse_orbifold(text).signature, canonical) << text;
}

// ----------------------------------------------------------------------------------- two ways to be read

struct Ambiguity {
  std::string text, by_digits;
  std::vector<std::string> others;
};

std::vector<Ambiguity> ambiguities() {
  return {{"1212", "1,2,1,2", {"12,12"}},
          {"2212", "2,2,1,2", {"2,2,12", "2,21,2"}},
          {"2233", "2,2,3,3", {"2,2,33"}},
          {"2332", "2,3,3,2", {"2,33,2"}},
          {"3322", "3,3,2,2", {"33,2,2"}},
          {"4747", "4,7,4,7", {"47,47"}},
          {"123123", "1,2,3,1,2,3", {"123,123"}},
          {"22100", "2,2,100", {}},
          {"*2212", "*2,2,1,2", {"*2,2,12", "*2,21,2"}},
          {"*1212", "*1,2,1,2", {"*12,12"}},
          {"22*", "2,2*", {"22,*"}},
          {"33*", "3,3*", {"33,*"}},
          {"2*22", "2*2,2", {"2*22,"}},
          {"22x", "2,2x", {"22,x"}},
          {"33x", "3,3x", {"33,x"}}};
}

TEST(Signature, AmbiguousTextsAreRefusedWithAllReadingsNamed) {
  for (const Ambiguity& expected : ambiguities()) {
    if (expected.others.empty()) {  // a zero that can end no other order
      EXPECT_EQ(parse_orbifold(expected.text).signature, expected.by_digits);
      continue;
    }
    std::string named;
    for (const std::string& other : expected.others) named += " or as " + other;
    EXPECT_EQ(refusal_of_symbol(expected.text),
              "'" + expected.text + "' could be read as " + expected.by_digits + named +
                  "; separate the orders by commas, as in '" + expected.others[0] + "'");
  }
}

TEST(Signature, EveryReadingThatIsNamedCanBeTypedAsItStands) {
  for (const Ambiguity& ambiguity : ambiguities()) {
    EXPECT_THAT(refusal_of_symbol(ambiguity.by_digits), Not(HasSubstr("could be read")));
    for (const std::string& reading : ambiguity.others) {
      EXPECT_EQ(refusal_of_symbol(reading), "");
    }
  }
}

// --------------------------------------------------------------------------------------- any text at all

/// What holds for every text: it is refused in one sentence, or |G| is 2 over the Euler characteristic, and
/// infinite where that is zero.
void check_any(const std::string& text) {
  try {
    const Target orbifold = parse_orbifold(text);
    const double chi = euler_characteristic(orbifold.symbol);
    const bool is_round = orbifold.space == Space::sphere();
    RC_ASSERT(std::abs(chi * orbifold.group_order - (is_round ? 2 : 0)) <= 1e-9);
    const bool is_hyperbolic = orbifold.space == Space::hyperbolic_plane();
    RC_ASSERT((is_round || (is_hyperbolic ? chi < -1e-12 : std::abs(chi) <= 1e-12)));
    RC_ASSERT((is_round        ? spherical(orbifold.symbol)
               : is_hyperbolic ? !orbifold.symbol.cross
                               : planar(orbifold.symbol)));
    RC_ASSERT((orbifold.topology == Topology::disk) == orbifold.symbol.star);
    RC_ASSERT((orbifold.topology == Topology::projective_plane) == orbifold.symbol.cross);
    RC_ASSERT(orbifold.symbol.star == (text.find('*') != std::string::npos));
    RC_ASSERT(parse_orbifold(orbifold.signature).signature == orbifold.signature);
  } catch (const ArgumentError& error) {
    const std::string sentence = error.what();
    RC_ASSERT(!sentence.empty());
    RC_ASSERT(sentence.find('\n') == std::string::npos);
    RC_ASSERT(text.empty() || sentence.rfind("'" + text + "' ", 0) == 0);
  }
}

RC_GTEST_PROP(Signature, AnyTextIsAnOrbifoldOrRefusedInOneSentence, ()) {
  check_any(*rc::gen::container<std::string>(rc::gen::elementOf(std::string("0123456789,*x"))));
}

RC_GTEST_PROP(Signature, AnyTextOfFewSignsIsAnOrbifoldOrRefusedInOneSentence, ()) {
  check_any(*rc::gen::container<std::string>(rc::gen::elementOf(std::string("122235,*"))));
}

RC_GTEST_PROP(Signature, OrdersBetweenCommasAreReadAsTheyStand, ()) {
  const auto order = rc::gen::element(1, 2, 2, 2, 3, 3, 4, 5, 6, 12, 12);
  const std::vector<int> wanted =
      *rc::gen::resize(4, rc::gen::nonEmpty(rc::gen::container<std::vector<int>>(order)));
  RC_PRE(wanted.size() >= 2u);
  const bool star = *rc::gen::arbitrary<bool>();
  const std::string text = test::symbol(star, wanted, true);
  const bool is_trivial = std::count(wanted.begin(), wanted.end(), 1) > 0;
  const bool accepted =
      spherical(wanted) || planar(wanted) || (!is_trivial && wanted.size() >= 3);  // hyperbolic
  RC_ASSERT(refusal_of_symbol(text).empty() == accepted);
  if (accepted) {
    RC_ASSERT(orders(parse_orbifold(text)) == wanted);
  }
}

TEST(Signature, DigitsWithoutCommasAreOneOrderEach) {
  for (const bool star : {false, true}) {
    for (int number = 22; number < 3000; ++number) {
      const std::string digits = std::to_string(number);
      if (digits.find_first_of("01") != std::string::npos) continue;
      std::vector<int> expected;
      for (const char digit : digits) expected.push_back(digit - '0');
      const std::string text = (star ? "*" : "") + digits;
      const bool is_flat_or_round = spherical(expected) || planar(expected);
      if (!is_flat_or_round && expected.size() >= 3) continue;  // hyperbolic, or read in two ways
      const bool accepted = is_flat_or_round;
      ASSERT_EQ(refusal_of_symbol(text).empty(), accepted) << text;
      if (accepted) {
        ASSERT_EQ(orders(parse_orbifold(text)), expected);
      }
    }
  }
}

TEST(Signature, LongTextsAreJudgedAtOnce) {
  EXPECT_THAT(refusal_of_symbol("111111111111*111111111111"), HasSubstr("order of 1"));
  EXPECT_EQ(parse_orbifold("222222222222*222222222222").space, Space::hyperbolic_plane());
  std::string many = "2";
  for (int k = 0; k < 10000; ++k) many += ",2";
  EXPECT_EQ(parse_orbifold(many).space, Space::hyperbolic_plane());
}

}  // namespace
}  // namespace orbitutte::signature_test
