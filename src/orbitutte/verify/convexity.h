// SPDX-License-Identifier: MIT
// Polygons on the sphere: the certificate's conditions on them beyond those on triangles.
#pragma once

#include <vector>

#include "orbitutte/orbifold/exact_positions.h"

namespace orbitutte {

/// Every polygon divided into the triangles between its edges and a new vertex in its middle.
struct DividedPolygons {
  /// Has triangles only. The new vertices follow the cut vertices; their source is -1.
  Embedding embedding;
  /// The input face of every triangle.
  std::vector<int> face_of;
};

/// The middle is the mean of the corners; it lies inside if the polygon is convex. Triangles stay whole. The
/// corners must name cut vertices.
DividedPolygons divide_from_middles(const Embedding& embedding);

/// A corner at which a polygon is not convex.
struct ConcaveCorner {
  /// A face of the input.
  int face = -1;
  /// A vertex of the cut mesh.
  int vertex = -1;
};

/// One corner of every polygon that is not strictly convex, by ascending face; signs are exact. The exact map
/// is straight at a vertex with two edges that is not a cone, whether the vertex lies between two faces or
/// along a mirror. Such a vertex may be off the arc between its neighbours by `straight_bound` radians to
/// either side. positions: the embedding's.
std::vector<ConcaveCorner> concave_corners(const Embedding& embedding, const ExactPositions& positions,
                                           double straight_bound);

}  // namespace orbitutte
