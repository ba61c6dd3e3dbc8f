// SPDX-License-Identifier: MIT
// Polygons on the sphere: what the certificate asks of them beyond what it asks of triangles.
#pragma once

#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Every polygon divided into the triangles between its edges and a new vertex in its middle.
struct DividedPolygons {
  Embedding embedding;  ///< in triangles alone; the new vertices follow the cut vertices, their source is -1
  std::vector<int> face_of;  ///< of every triangle: the input face
};

/// The middle is the mean of the corners, inside wherever the polygon is convex; triangles stay whole. The
/// corners must name cut vertices.
DividedPolygons divide_from_middles(const Embedding& embedding);

/// A corner at which a polygon is not convex.
struct ConcaveCorner {
  int face = -1;    ///< of the input
  int vertex = -1;  ///< of the cut mesh
};

/// One corner of every polygon that is not strictly convex, exact in sign, ascending by faces. At vertices
/// with two edges, which are no cones, the exact map is straight, be it between two faces or along a mirror:
/// there the vertex may be off the arc between its neighbours by `straight_bound` radians to either side.
std::vector<ConcaveCorner> concave_corners(const Embedding& embedding, double straight_bound);

}  // namespace orbitutte
