// SPDX-License-Identifier: MIT
// The sphere and the plane side by side: points are vectors of R^3, isometries 3 x 3 matrices.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte {

enum class Geometry {
  spherical,  ///< the unit sphere; isometries are orthogonal
  euclidean   ///< the plane z = 1; isometries are [R t; 0 1]
};

/// The inverse of an isometry of either geometry, exact up to the sign of zeros on the sphere. An orthogonal
/// matrix whose last row is (0, 0, 1) is one of both, and has the same inverse in both.
Matrix3 inverse_isometry(const Matrix3& isometry);

/// What an isometry does to differences of points: itself on the sphere; without its translation in the
/// plane.
Matrix3 linear_part(const Matrix3& isometry);

}  // namespace orbitutte
