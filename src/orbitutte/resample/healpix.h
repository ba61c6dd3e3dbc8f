// SPDX-License-Identifier: MIT
// HEALPix: K. M. Gorski et al., "HEALPix: a framework for high-resolution discretization and fast analysis of
// data distributed on the sphere", Astrophysical Journal 622 (2005), sections 4 and 5. Private to resample/.
#pragma once

#include <vector>

#include "orbitutte/resample/sparse_table.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// The pixels of HEALPix: 12 side^2 of equal area, on 4 side - 1 rings around the z axis.
class Healpix {
 public:
  explicit Healpix(int side) : side_(side) {}

  int side() const { return side_; }
  int pixel_count() const { return 12 * side_ * side_; }

  /// The centres of all pixels in the order of the rings, from the north (z = 1) and from longitude 0: unit
  /// vectors.
  Points centres() const;

  /// For each pixel in the nested order its number in the order of the rings. `side` must be a power of two.
  std::vector<int> rings_of_nested() const;

  /// The pixels (in the order of the rings) that a value at a point comes from: the two nearest ones on the
  /// rings above and below, linear in the longitude along the rings and in the colatitude between them; on a
  /// cap, inside of the first ring, the mean of its four pixels stands for the pole.
  Stencil stencil(const Vector3& point) const;

 private:
  struct Ring {
    /// The number of its pixels, and the first of them.
    int count = 0, first = 0;
    double z = 0;

    /// The longitude of the first pixel in steps: 1/2 or 0.
    double shift = 0;
  };

  /// Ring i = 1 .. 4 side - 1, from the north.
  Ring ring(int i) const;

  /// The last ring above a point at the height z; 0 for none.
  int ring_above(double z) const;

  int side_;
};

}  // namespace orbitutte
