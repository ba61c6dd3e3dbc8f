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
  std::vector<int> orders;
  int group_order = 1;

  Topology topology() const { return star ? Topology::disk : Topology::sphere; }
};

/// Orders between commas, or without any.
inline std::string symbol(bool star, const std::vector<int>& orders, bool commas) {
  std::string text = star ? "*" : "";
  for (std::size_t k = 0; k < orders.size(); ++k)
    text += (commas && k > 0 ? "," : "") + std::to_string(orders[k]);
  return text;
}

/// One character per order while each is a single digit, commas otherwise.
inline std::string symbol(const SphericalOrbifold& orbifold) {
  const bool commas = *std::max_element(orbifold.orders.begin(), orbifold.orders.end()) >= 10;
  return symbol(orbifold.star, orbifold.orders, commas);
}

/// All ten families, those with a free order for N = 2, 3, 4, 8, 12, 100.
inline std::vector<SphericalOrbifold> spherical_orbifolds() {
  std::vector<SphericalOrbifold> result;
  for (const bool star : {false, true}) {
    const int sheets = star ? 2 : 1;
    const std::string prefix = star ? "*" : "";
    result.push_back({prefix + "532", star, {5, 3, 2}, 60 * sheets});
    result.push_back({prefix + "432", star, {4, 3, 2}, 24 * sheets});
    result.push_back({prefix + "332", star, {3, 3, 2}, 12 * sheets});
    for (const int N : {2, 3, 4, 8, 12, 100}) {
      result.push_back({prefix + "22N", star, {2, 2, N}, 2 * N * sheets});
      result.push_back({prefix + "NN", star, {N, N}, N * sheets});
    }
  }
  return result;
}

/// The same with the orders in every arrangement.
inline std::vector<SphericalOrbifold> arranged_orbifolds() {
  std::vector<SphericalOrbifold> result;
  for (SphericalOrbifold orbifold : spherical_orbifolds()) {
    std::sort(orbifold.orders.begin(), orbifold.orders.end());
    do {
      result.push_back(orbifold);
    } while (std::next_permutation(orbifold.orders.begin(), orbifold.orders.end()));
  }
  return result;
}

}  // namespace orbitutte::test
