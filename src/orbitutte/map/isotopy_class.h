// SPDX-License-Identifier: MIT
// Which of the maps between two spheres with corresponding cones is meant: they differ by twists around some
// of the cones. Of the conformal tiles of both surfaces, the marking of one is changed until they are most
// alike.
#pragma once

#include <complex>

#include "orbitutte/orbifold/braid.h"

namespace orbitutte {

/// The class that was found.
struct IsotopyClass {
  /// Takes the cones of tile B to places where they are most like those of tile A. A pure braid: every place
  /// has its own cone in the end.
  Braid braid;

  /// By how much the tiles differ in this class, and in the next.
  double distance = 0, next_distance = 0;
};

/// Of four cones of order two in the plane (the positions of the marks, x + iy), exactly: the shape is
/// t = (p_3 - p_2)/(p_2 - p_1) in the upper half plane, on which pure braids act as Gamma(2) does, generated
/// by t - 2 and t/(1 + 2t). The distance is that of the hyperbolic plane, the logarithm of the dilatation of
/// the affine map between the tiles.
IsotopyClass isotopy_class_of_four(const Eigen::VectorXcd& a, const Eigen::VectorXcd& b);

/// Of five to eight cones of one order in the hyperbolic plane (k x 3, both closed), by a search: the
/// distance is the root mean square of log(d_ij in A/d_ij in B) over all pairs of cones. Braids that gain at
/// least 2 % are applied one after the other: full twists of two cones, and of runs of neighbours; as long as
/// the distance is above 0.1, two at once are tried, too. Where all of them together leave more than 0.6 of
/// the distance, the empty braid is taken: cuts along short tours are rarely twisted.
IsotopyClass isotopy_class(const Moduli& moduli, const Points& a, const Points& b);

}  // namespace orbitutte
