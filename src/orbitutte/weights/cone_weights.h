// SPDX-License-Identifier: MIT
// Weights around cones, where a conformal map is a power that no piecewise linear map comes near.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// What the angles at a vertex add up to in the image.
struct ConeAngle {
  int vertex = -1;
  double angle = 0;  ///< radians
};

/// Weights of an intrinsic Delaunay triangulation in a metric that is flat at the cones; others come back as
/// they are. The Dirichlet energy is conformally invariant, so cotangents may be taken from any metric that
/// is conformal to the surface's. At a cone whose angles, T in all, become S, that is the metric of z -> z^b,
/// b = S/T: sides r that meet at the cone become r^b, and the angles between them b times as large. In it the
/// conformal map is smooth at the cone. In the mesh's own metric the elements there miss most of it, and the
/// error falls with the distance r as slowly as (h/r)^(2b), h the length of an edge: on a mesh of 270,000
/// triangles it makes most of the mean angle distortion. A face with two cones stays as it is; flips make the
/// triangulation Delaunay in the new metric, but join no two vertices of `apart`.
EdgeWeights sharpened_at_cones(const EdgeWeights& weights, const std::vector<ConeAngle>& cones,
                               const std::vector<std::array<int, 2>>& apart = {});

/// edge_weights whose triangulation, if they have one, has no edge between two vertices of `apart`: those at
/// opposite points of the sphere, between which every arc is as short as any other. `weights`: what
/// edge_weights has found without that wish; they come back if they meet it.
EdgeWeights kept_apart(const EdgeWeights& weights, const std::vector<std::array<int, 2>>& apart,
                       const Mesh& mesh, const Connectivity& connectivity, const WeightOptions& options);

}  // namespace orbitutte
