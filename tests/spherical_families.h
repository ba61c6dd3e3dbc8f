// SPDX-License-Identifier: MIT
// The families of spherical orbifolds that can be embedded, told apart from the library's table.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte::test {

struct SphericalOrbifold {
  std::string family;
  bool star = false;
  std::vector<int> orders;  ///< of all marks, in the order of the symbol
  int group_order = 1;
  int inside = 0;   ///< so many of the orders stand before the star
  int mirrors = 0;  ///< sides of the tile
  bool cross = false;

  Topology topology() const {
    return cross ? Topology::projective_plane : star ? Topology::disk : Topology::sphere;
  }
};

/// Orders between commas, or without any; the star stands behind the first `inside`.
inline std::string symbol(bool star, const std::vector<int>& orders, bool commas, int inside = 0) {
  std::string text;
  for (int k = 0; k <= static_cast<int>(orders.size()); ++k) {
    if (star && k == inside) text += "*";
    if (k == static_cast<int>(orders.size())) break;
    text += (commas && k != 0 && !(star && k == inside) ? "," : "") + std::to_string(orders[k]);
  }
  return text.empty() ? "1" : text;
}

inline std::string symbol(const SphericalOrbifold& orbifold, bool commas) {
  return symbol(orbifold.star, orbifold.orders, commas, orbifold.star ? orbifold.inside : 0) +
         (orbifold.cross ? "x" : "");
}

/// One character per order while each is a single digit, commas otherwise.
inline std::string symbol(const SphericalOrbifold& orbifold) {
  return symbol(orbifold,
                std::any_of(orbifold.orders.begin(), orbifold.orders.end(), [](int n) { return n >= 10; }));
}

/// All families that are embedded, those with a free order for N = 2, 3, 4, 8, 12, 100.
inline std::vector<SphericalOrbifold> spherical_orbifolds() {
  std::vector<SphericalOrbifold> result;
  for (const bool star : {false, true}) {
    const int sheets = star ? 2 : 1, three = star ? 0 : 3, two = star ? 0 : 2;
    const std::string prefix = star ? "*" : "";
    result.push_back({prefix + "532", star, {5, 3, 2}, 60 * sheets, three, 3 - three});
    result.push_back({prefix + "432", star, {4, 3, 2}, 24 * sheets, three, 3 - three});
    result.push_back({prefix + "332", star, {3, 3, 2}, 12 * sheets, three, 3 - three});
    for (const int N : {2, 3, 4, 8, 12, 100}) {
      result.push_back({prefix + "22N", star, {2, 2, N}, 2 * N * sheets, three, 3 - three});
      result.push_back({prefix + "NN", star, {N, N}, N * sheets, two, 2 - two});
    }
  }
  result.push_back({"3*2", true, {3, 2}, 24, 1, 2});
  for (const int N : {2, 3, 4, 8, 12, 100}) {
    result.push_back({"2*N", true, {2, N}, 4 * N, 1, 2});
    result.push_back({"N*", true, {N}, 2 * N, 1, 1});
  }
  for (const int N : {1, 2, 3, 4, 8, 12, 100}) result.push_back({"Nx", false, {N}, 2 * N, 1, 0, true});
  result.push_back({"1", false, {}, 1});
  result.push_back({"*", true, {}, 2, 0, 1});
  return result;
}

/// The same with the orders on each side of the star in every arrangement.
inline std::vector<SphericalOrbifold> arranged_orbifolds() {
  std::vector<SphericalOrbifold> result;
  for (SphericalOrbifold orbifold : spherical_orbifolds()) {
    const auto begin = orbifold.orders.begin() + (orbifold.star ? orbifold.inside : 0);
    std::sort(begin, orbifold.orders.end());
    do {
      result.push_back(orbifold);
    } while (std::next_permutation(begin, orbifold.orders.end()));
  }
  return result;
}

}  // namespace orbitutte::test
