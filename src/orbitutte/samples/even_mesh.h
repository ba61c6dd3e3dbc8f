// SPDX-License-Identifier: MIT
// Even triangles on a smooth surface.
#pragma once

#include <functional>

#include "orbitutte/types.h"

namespace orbitutte {

/// A function's value at a point and its gradient there.
struct FieldSample {
  double value = 0;
  Vector3 gradient = Vector3::Zero();
};

/// The zero set of a smooth function that is negative inside. Where the surface ends, its boundary curve lies
/// in a plane through 0.
struct SmoothSurface {
  std::function<FieldSample(const Vector3&)> field;
  Vector3 rim_normal = Vector3::UnitZ();  ///< of that plane, a unit vector
};

/// A mesh of the surface in triangles that are close to regular, grown out of a coarse manifold one with the
/// same topology: long edges are split, edges flipped to Delaunay's, vertices moved to the middle of their
/// surroundings. Up to 10,000 it has `faces` faces, or one more where a closed surface would need an odd
/// number, and no fewer than `coarse`. Above, a mesh of 2,500 to 10,000 faces is divided, every triangle in
/// four, as often as needed: time O(faces). After J. Tournois et al., Interleaving Delaunay refinement and
/// optimization (2009), with the area-weighted centroids of L. Chen, Mesh smoothing schemes based on optimal
/// Delaunay triangulations (2004).
Mesh even_mesh(Mesh coarse, const SmoothSurface& surface, int faces);

}  // namespace orbitutte
