// SPDX-License-Identifier: MIT
// Meshes of smooth surfaces in nearly regular triangles.
#pragma once

#include <functional>

#include "orbitutte/types.h"

namespace orbitutte {

/// A function's value at a point and its gradient there.
struct FieldSample {
  double value = 0;
  Vector3 gradient = Vector3::Zero();
};

/// The zero set of a smooth function that is negative inside. If the surface has a boundary curve, the curve
/// lies in a plane through 0.
struct SmoothSurface {
  std::function<FieldSample(const Vector3&)> field;
  /// The unit normal of that plane.
  Vector3 rim_normal = Vector3::UnitZ();
};

/// A mesh of the surface in triangles that are close to regular. It grows from a coarse manifold mesh of the
/// same topology: long edges are split, edges are flipped to Delaunay, and vertices are moved to the middle
/// of their surroundings. Up to 10,000, the mesh has `faces` faces, or one more if a closed surface would
/// need an odd number, and never fewer than `coarse`. Above that, a mesh of 2,500 to 10,000 faces is divided,
/// each triangle into four, as often as needed: time O(faces). After J. Tournois et al., Interleaving
/// Delaunay refinement and optimization (2009), with the area-weighted centroids of L. Chen, Mesh smoothing
/// schemes based on optimal Delaunay triangulations (2004).
Mesh even_mesh(Mesh coarse, const SmoothSurface& surface, int faces);

}  // namespace orbitutte
