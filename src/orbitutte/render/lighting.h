// SPDX-License-Identifier: MIT
// Normals, lights and shade.
#pragma once

#include <functional>

#include "orbitutte/render/image.h"
#include "orbitutte/render/ray_scene.h"

namespace orbitutte {

/// The normals of all corners of a mesh, 3 m x 3, row 3 f + k at F(f, k).
using CornerNormals = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Faces around a vertex share a normal, the mean weighted by area, as long as no edge sharper than `crease`
/// (radians) parts them: smooth surfaces look smooth, and edges of machine parts stay sharp. O(m).
CornerNormals corner_normals(const Points& V, const Triangles& F, double crease);

/// How much light reaches a point, 0 .. 1 each.
struct Exposure {
  /// The share of the light from all around.
  float openness = 1;
  /// The share of the main light.
  float lit = 1;
};

/// How bright a white, matt surface looks, about 0 .. 1, lit from above the viewer's left shoulder, filled in
/// from the right, and from all around.
/// normal: unit, in the camera's frame (right, up, towards the viewer).
float brightness(const Vector3f& normal, const Exposure& exposure);

/// What a slightly glossy surface reflects of the main light besides, about 0 .. 0.1.
float gloss(const Vector3f& normal);

/// Does anything lie on a ray?
using Blocker = std::function<bool(const Ray&)>;

/// The share of the hemisphere above a point that nothing blocks within `from.length`, estimated with so
/// many rays. Their directions are spread evenly over the samples of a pixel, and turned from pixel to pixel
/// so that the remaining noise is finely grained. from: its origin just above the surface, its direction the
/// unit normal.
float openness(const Blocker& is_blocked, const Ray& from, int rays, const Sample& sample);

/// Does the main light, which is as wide as a lamp near by, reach a point? 1 or 0; the mean over the samples
/// of a pixel is its share. origin: just above the surface; axes: the camera's (rows).
float lit(const Blocker& is_blocked, const Vector3f& origin, const Matrix3& axes, const Sample& sample);

}  // namespace orbitutte
