// SPDX-License-Identifier: MIT
// Normals, lights and shade.
#pragma once

#include <bitset>
#include <functional>

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

/// Which of these rays does anything lie on?
using Blocker = std::function<std::bitset<packet_size>(const Packet&)>;

/// The share of the hemisphere above a point that nothing blocks within `from.length`, estimated with a few
/// rays, whose directions are turned by a share 0 .. 1 of a full turn. from: its origin just above the
/// surface, its direction the unit normal.
float openness(const Blocker& are_blocked, const Ray& from, float turn);

/// The share of the main light, which is as wide as a lamp near by, that reaches a point, estimated in the
/// same way. origin: just above the surface; axes: the camera's (rows).
float lit(const Blocker& are_blocked, const Vector3f& origin, const Matrix3& axes, float turn);

}  // namespace orbitutte
