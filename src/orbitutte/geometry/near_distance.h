// SPDX-License-Identifier: MIT
// The distance of neighbours, as energies and forces need it: both power series of Curvature side by side.
#pragma once

#include <array>

#include "orbitutte/geometry/curvature.h"

namespace orbitutte {

/// d/sn d, and d^2 over the squared chord c = 4 sn^2(d/2), of points with a distance d.
using DistanceFactors = Eigen::Array2d;

/// With G_j = 4^j j!^2/(2j + 1)!, they are the sums of G_j (k c/4)^j and of G_j/(j + 1) (k c/4)^j.
template <int k>
struct NearDistance {
  /// Squared chords below this one are near: the first term left out is below half a unit in the last place.
  static constexpr double farthest = 0x1p-9;

  static DistanceFactors factors(double squared_chord) {
    DistanceFactors sum = {series[terms - 1][0], series[terms - 1][1]};
    for (std::size_t j = terms - 1; j-- > 0;)
      sum = sum * squared_chord + DistanceFactors(series[j][0], series[j][1]);
    return sum;
  }

 private:
  static constexpr std::size_t terms = 5;

  static constexpr std::array<std::array<double, 2>, terms> series = [] {
    std::array<std::array<double, 2>, terms> result = {};
    double coefficient = 1;  // G_j (k/4)^j
    for (std::size_t j = 0; j < terms; ++j) {
      result[j] = {coefficient, coefficient / static_cast<double>(j + 1)};
      coefficient *= k / 2.0 * static_cast<double>(j + 1) / static_cast<double>(2 * j + 3);
    }
    return result;
  }();
};

}  // namespace orbitutte
