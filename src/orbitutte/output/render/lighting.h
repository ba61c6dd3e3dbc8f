// SPDX-License-Identifier: MIT
// Normals, lights and shade.
#pragma once

#include "orbitutte/output/render/image.h"
#include "orbitutte/output/render/ray_scene.h"

namespace orbitutte {

/// The normals of all corners of a mesh, 3 m x 3, row 3 f + k at F(f, k).
using CornerNormals = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Faces around a vertex share a normal, the mean weighted by area, as long as no edge sharper than `crease`
/// (radians) parts them: smooth surfaces look smooth, and edges of machine parts stay sharp. O(m).
CornerNormals corner_normals(const Points& V, const Faces& F, double crease);

/// How bright a white, matt surface looks, about 0 .. 1, lit from above the viewer's left shoulder, filled in
/// from the right, and from all around as far as the surroundings are open.
/// normal: unit, in the camera's frame (right, up, towards the viewer); openness: 0 .. 1.
float brightness(const Vector3f& normal, float openness);

/// What a slightly glossy surface reflects of the main light besides, about 0 .. 0.1.
float gloss(const Vector3f& normal);

/// The share of the hemisphere above a point that nothing blocks within `reach`, estimated with a few rays.
/// Over the samples of a pixel their directions are spread evenly, and from pixel to pixel they are turned
/// such that what noise remains is finely grained. from: its origin just above the surface, its direction the
/// unit normal.
float openness(const RayScene& scene, const Ray& from, float reach, const Sample& sample);

}  // namespace orbitutte
