// SPDX-License-Identifier: MIT
// Distances in the three geometries (Space) with as many digits as are wanted: Real is double or one of the
// numbers of precise.h.
#pragma once

#include <cmath>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/geometry/space.h"

namespace orbitutte {

/// d/sn d of the squared chord s up to an error, the sum of G_j (k s/4)^j with G_j = 4^j j!^2/(2j + 1)!. Of
/// long edges doubles have to do.
template <typename Real>
Real precise_over_sn(Space space, const Real& s, double error) {
  using std::abs;
  constexpr double longest = 2.5, of_doubles = 1e-15;
  const int k = space.curvature();
  const double rough = static_cast<double>(s);
  if (k == 0) return 1;
  if (error >= of_doubles || !(rough < longest))
    return k > 0 ? Curvature<1>::over_sn(rough) : Curvature<-1>::over_sn(rough);
  const Real ratio = k * s / 4;
  Real sum = 1, term = 1;
  for (int j = 1; j < 500 && abs(term) > error; ++j) {
    term *= ratio * (2 * j);
    term /= 2 * j + 1;
    sum += term;
  }
  return sum;
}

}  // namespace orbitutte
