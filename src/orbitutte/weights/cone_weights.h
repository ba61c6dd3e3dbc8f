// SPDX-License-Identifier: MIT
// Weights around cones, where a conformal map is a power, which piecewise linear maps approximate badly.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// The sum of the angles at a vertex in the image.
struct ConeAngle {
  int vertex = -1;
  /// Radians.
  double angle = 0;
};

/// An intrinsic Delaunay triangulation in a metric that is flat at the cones.
///
/// The Dirichlet energy is conformally invariant, so cotangents may be taken from any metric that is
/// conformal to the surface's. If the angles at a cone add up to T on the mesh and to S in the image, this is
/// the metric of z -> z^b, b = S/T: sides r that meet at the cone become r^b, and the angles between them are
/// multiplied by b. In this metric the conformal map is smooth at the cone. In the mesh's own metric the
/// elements there approximate it badly, and the error falls with the distance r only as (h/r)^(2b), where h
/// is the length of an edge: on a mesh of 270,000 triangles it causes most of the mean angle distortion.
///
/// A face with two cones stays as it is. Flips make the triangulation Delaunay in the new metric, but join no
/// two vertices of `kept_apart`.
IntrinsicTriangulation flattened_at_cones(IntrinsicTriangulation T, const std::vector<ConeAngle>& cones);

/// intrinsic_weights of the triangulation that flattened_at_cones makes of that of `weights`, where it joins
/// no two vertices of `apart`; weights of other kinds are returned unchanged.
EdgeWeights sharpened_at_cones(const EdgeWeights& weights, const std::vector<ConeAngle>& cones,
                               const std::vector<std::array<int, 2>>& apart = {});

/// delaunay_triangulation(surface, unflipped), if T, which was found without unflipped.kept_apart, joins such
/// a pair; otherwise T, whose later flips join none.
IntrinsicTriangulation kept_apart(IntrinsicTriangulation T, const Surface& surface,
                                  const UnflippedEdges& unflipped);

/// edge_weights(surface, options, unflipped), if the triangulation of `weights`, which were found without
/// unflipped.kept_apart, joins such a pair; otherwise these. A map puts the pairs at opposite points of the
/// sphere, where every arc between them is as short as any other.
EdgeWeights kept_apart(const EdgeWeights& weights, const Surface& surface, const WeightOptions& options,
                       const UnflippedEdges& unflipped);

}  // namespace orbitutte
