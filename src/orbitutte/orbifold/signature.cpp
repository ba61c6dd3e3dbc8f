// SPDX-License-Identifier: MIT
// J. H. Conway, H. Burgiel, C. Goodman-Strauss, "The Symmetries of Things", chapters 3, 4 and 9.
#include "orbitutte/orbifold/signature.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "orbitutte/orbifold/families.h"

namespace orbitutte {
namespace {

using Orders = std::vector<int>;

// A rational number that counts down: exact to the first value below zero, where it stays. With orders of at
// most 20,000 the values from zero up have small denominators, so nothing overflows.
struct Fraction {
  long long numerator = 0, denominator = 1;

  Fraction minus(long long n, long long d) const {
    if (numerator < 0) return *this;
    const long long top = numerator * d - n * denominator, bottom = denominator * d,
                    common = std::gcd(top, bottom);
    return {top / common, bottom / common};
  }
};

// The orbifold's Euler characteristic: 2 - sum (1 - 1/n) - [star] - sum (1 - 1/m)/2 - [cross]; |G| is 2 over
// it.
Fraction euler_characteristic(const ConwaySymbol& symbol) {
  Fraction chi = {2 - symbol.star - symbol.cross, 1};  // first, so that few orders bring it below zero
  for (const long long n : symbol.rotations) chi = chi.minus(n - 1, n);
  for (const long long m : symbol.corners) chi = chi.minus(m - 1, 2 * m);
  return chi;
}

// A single order of several digits ends with a comma if each digit could be an order.
std::string join(const Orders& orders) {
  const bool digits = std::all_of(orders.begin(), orders.end(), [](int n) { return n < 10; });
  const std::string text = fmt::format("{}", fmt::join(orders, digits ? "" : ","));
  const bool alone = orders.size() == 1 && !digits;
  return alone && text.find_first_of("01") == std::string::npos ? text + "," : text;
}

bool any_below_two(const Orders& orders) {
  return std::any_of(orders.begin(), orders.end(), [](int n) { return n < 2; });
}

// An order of one marks nothing. It is part of a name only if it is alone before the cross (1x).
bool trivial_order(const ConwaySymbol& symbol) {
  const bool alone_before_cross = symbol.cross && symbol.rotations.size() == 1;
  return (!alone_before_cross && any_below_two(symbol.rotations)) || any_below_two(symbol.corners);
}

constexpr int largest_order = 20000;

bool any_above_largest(const Orders& orders) {
  return std::any_of(orders.begin(), orders.end(), [](int n) { return n > largest_order; });
}

std::string above_largest() {
  return fmt::format("has an order above {}, the largest that is supported", largest_order);
}

[[noreturn]] void refuse(const std::string& text, const std::string& reason) {
  throw ArgumentError(fmt::format("'{}' {}", text, reason));
}

// The ways to read a string of digits without commas as orders: one digit each, then those with longer
// numbers and at most three orders, since no spherical orbifold has more.
void readings(const std::string& digits, std::size_t from, Orders& prefix, std::vector<Orders>& all) {
  if (!all.empty() && prefix.size() > 3) return;
  if (from == digits.size()) {
    all.push_back(prefix);
    return;
  }
  if (digits[from] == '0') return;
  int order = 0;
  for (std::size_t end = from; end < digits.size() && order <= largest_order; ++end) {
    order = 10 * order + (digits[end] - '0');
    prefix.push_back(order);
    readings(digits, end + 1, prefix, all);
    prefix.pop_back();
  }
}

int parse_order(const std::string& text, const std::string& number) {
  int order = 0;
  for (const char digit : number) order = std::min(10 * order + (digit - '0'), largest_order + 1);
  if (number.empty()) refuse(text, "has an empty place between commas; give every order once");
  if (order < 1) refuse(text, "has an order of 0; orders are 2 or more");
  if (order > largest_order) refuse(text, above_largest());
  return order;
}

// The possible readings of one half of a symbol. With commas there is exactly one; a comma at the end
// ("22,*") may mark a single order of two digits as such.
std::vector<Orders> read_orders(const std::string& text, std::string part) {
  if (part.empty()) return {Orders()};
  if (part.find(',') == std::string::npos) {
    std::vector<Orders> all;
    Orders prefix;
    if (part.size() > 12) refuse(text, "has too many digits without commas; separate the orders by commas");
    readings(part, 0, prefix, all);
    return all;
  }
  if (part.back() == ',') part.pop_back();
  Orders orders;
  for (std::size_t from = 0; from <= part.size();) {
    const std::size_t end = std::min(part.find(',', from), part.size());
    orders.push_back(parse_order(text, part.substr(from, end - from)));
    from = end + 1;
  }
  return {orders};
}

struct Halves {
  std::string before, after;
  bool star = false, cross = false;
};

Halves split(const std::string& text) {
  Halves halves;
  for (std::size_t k = 0; k < text.size(); ++k) {
    const char c = text[k];
    const bool multiplication_sign = text.compare(k, 2, "\xc3\x97") == 0;
    if ((c >= '0' && c <= '9') || c == ',') {
      if (halves.cross) refuse(text, "has orders after the cross; rotations come before it");
      (halves.star ? halves.after : halves.before) += c;
    } else if (c == '*' && !halves.star && !halves.cross) {
      halves.star = true;
    } else if ((c == 'x' || c == 'X' || multiplication_sign) && !halves.star && !halves.cross) {
      halves.cross = true;
      if (multiplication_sign) ++k;
    } else if (c == 'N') {
      refuse(text, "has the letter N, which stands for any order; put a number for it, as in 22* or 2,2,12");
    } else if (c == '*' || c == 'x' || c == 'X' || multiplication_sign) {
      refuse(text, "has more than one star or cross; orbifolds with two have no tile here");
    } else {
      refuse(text,
             "is no Conway symbol: it may hold digits, commas, one '*' and one 'x'; see 'orbitutte types'");
    }
  }
  if (text.empty()) throw ArgumentError("the symbol is empty; see 'orbitutte types'");
  return halves;
}

// Names that people know for what has a symbol.
std::string symbol_of(const std::string& name) {
  return name == "sphere" ? "1" : name == "hemisphere" ? "*" : name;
}

std::vector<ConwaySymbol> all_readings(const std::string& text) {
  Halves halves = split(text);
  if (halves.cross && halves.before.empty()) halves.before += '1';   // one vertex marked
  if (!halves.cross && halves.before == "1") halves.before.clear();  // the trivial group's symbol
  std::vector<ConwaySymbol> result;
  for (const Orders& before : read_orders(text, halves.before)) {
    for (const Orders& after : read_orders(text, halves.after))
      result.push_back({before, after, halves.star, halves.cross});
  }
  if (result.empty()) refuse(text, "has an order of 0; orders are 2 or more");
  return result;
}

bool is_bad(const ConwaySymbol& symbol) {
  const Orders& orders = symbol.star ? symbol.corners : symbol.rotations;
  if (symbol.cross || (symbol.star && !symbol.rotations.empty())) return false;
  return orders.size() == 1 || (orders.size() == 2 && orders[0] != orders[1]);
}

std::string commas(const ConwaySymbol& symbol) {
  const auto list = [](const Orders& orders) {
    return fmt::format("{}{}", fmt::join(orders, ","), orders.size() == 1 && orders[0] >= 10 ? "," : "");
  };
  return list(symbol.rotations) + (symbol.star ? "*" : "") + list(symbol.corners) + (symbol.cross ? "x" : "");
}

// The hyperbolic orbifolds of spheres and disks: all other orders that are large or many enough.
bool is_hyperbolic(const ConwaySymbol& symbol) {
  return !symbol.cross && !trivial_order(symbol) && euler_characteristic(symbol).numerator < 0;
}

bool has_target(const ConwaySymbol& symbol) {
  return find_family(symbol) != nullptr || is_hyperbolic(symbol);
}

// Why a reading cannot be embedded; empty if it can.
std::string objection(const ConwaySymbol& symbol) {
  if (any_above_largest(symbol.rotations) || any_above_largest(symbol.corners)) return above_largest();
  if (has_target(symbol)) return {};
  if (trivial_order(symbol)) return "has an order of 1, which marks nothing; orders are 2 or more";
  if (is_bad(symbol))
    return "is not an orbifold of the sphere: one order alone, or two different ones, close up no tiling (a "
           "teardrop or spindle)";
  const long long chi = euler_characteristic(symbol).numerator;
  if (chi == 0)
    return "is a Euclidean orbifold for which there is no tile; of those there are 333, 442, 632, 2222, "
           "*333, "
           "*442, *632 and *2222";
  return "is a hyperbolic orbifold with a cross; of hyperbolic ones there are those of spheres and disks";
}

// The reading by the rule of the notation: one character per order, unless a half is a single number that can
// be read in no other way ("2*12", "12*").
const ConwaySymbol& choose(const std::string& text, const std::vector<ConwaySymbol>& all) {
  const auto embeds = [](const ConwaySymbol& s) { return find_family(s) != nullptr; };
  if (text.find(',') != std::string::npos && all.size() == 1) return all.front();
  const ConwaySymbol& digits = all.front();  // the readings begin with the one of single digits
  if (embeds(digits)) return digits;
  std::vector<const ConwaySymbol*> others;
  for (std::size_t k = 1; k < all.size(); ++k)
    if (embeds(all[k])) others.push_back(&all[k]);
  if (others.empty()) return digits;
  const bool lone = others.size() == 1 && others[0]->rotations.size() <= 1 && others[0]->corners.size() <= 1;
  if (lone && (trivial_order(digits) || text.find('0') != std::string::npos)) return *others[0];
  std::string named;
  for (const ConwaySymbol* other : others) named += (named.empty() ? "" : " or as ") + commas(*other);
  refuse(text, fmt::format("could be read as {} or as {}; separate the orders by commas, as in '{}'",
                           commas(digits), named, commas(*others[0])));
}

std::vector<Mark> marks_of(const ConwaySymbol& symbol) {
  std::vector<Mark> marks;
  for (const int n : symbol.rotations) marks.push_back(Mark::of_order(n, ConeKind::rotation));
  for (const int m : symbol.corners) marks.push_back(Mark::of_order(m, ConeKind::corner));
  return marks;
}

// The sign of the Euler characteristic is that of the curvature (Gauss and Bonnet).
Space space_of(const Fraction& chi) {
  if (chi.numerator > 0) return Space::sphere();
  return chi.numerator == 0 ? Space::plane() : Space::hyperbolic_plane();
}

}  // namespace

std::string ConwaySymbol::text() const {
  if (rotations.empty() && corners.empty() && !star && !cross) return "1";
  if (is_hyperbolic(*this)) return commas(*this);  // 2,2,2,2,2 or 2,2,222
  return join(rotations) + (star ? "*" : "") + join(corners) + (cross ? "x" : "");
}

Target parse_orbifold(const std::string& signature) {
  const ConwaySymbol symbol = choose(signature, all_readings(symbol_of(signature)));
  if (const std::string reason = objection(symbol); !reason.empty()) refuse(signature, reason);
  const Fraction chi = euler_characteristic(symbol);
  Target target;
  target.signature = symbol.text();
  target.symbol = symbol;
  target.space = space_of(chi);
  const Family* const family = find_family(symbol);
  target.topology = family ? family->topology : symbol.star ? Topology::disk : Topology::sphere;
  target.marks = marks_of(symbol);
  target.inner_marks = static_cast<int>(symbol.rotations.size());
  target.group_order = chi.numerator > 0 ? static_cast<int>(2 * chi.denominator / chi.numerator) : 0;
  target.has_free_tile = !family || !family->tile;
  target.is_free_to_rotate =
      !target.has_free_tile && is_free_to_rotate(basic_tile(target, first_arrangement(target)));
  return target;
}

Target standard_target(Topology topology) {
  if (topology == Topology::projective_plane) return parse_orbifold("1x");
  return parse_orbifold(topology == Topology::disk ? "*222" : "222");
}

bool are_opposite(const std::vector<Mark>& marks) {
  return marks.size() == 2 && marks[0].angle == marks[1].angle && marks[0].kind == marks[1].kind &&
         marks[0].kind != ConeKind::fixed;
}

std::vector<double> metric_angles(const std::vector<Mark>& marks) {
  const bool slides = are_opposite(marks);
  std::vector<double> angles;
  angles.reserve(marks.size());
  for (const Mark& mark : marks) angles.push_back((slides ? 2 : 1) * mark.angle);
  return angles;
}

namespace {

// The family's pattern with the least N that it allows.
ConwaySymbol with_least_order(const Family& family) {
  ConwaySymbol symbol = family.pattern;
  for (Orders* orders : {&symbol.rotations, &symbol.corners})
    std::replace(orders->begin(), orders->end(), 0, family.smallest_order);
  return symbol;
}

}  // namespace

std::vector<FamilyDescription> families() {
  std::vector<FamilyDescription> result;
  for (const Family& family : family_table()) {
    const Space space = space_of(euler_characteristic(with_least_order(family)));
    result.push_back({family.name, family.group_order, family.topology, family.marked_points, space});
  }
  return result;
}

}  // namespace orbitutte
