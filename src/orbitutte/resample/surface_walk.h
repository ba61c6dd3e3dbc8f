// SPDX-License-Identifier: MIT
// Many points located on an embedded surface by walks from one to the next. Private to resample/.
#pragma once

#include <memory>

#include "orbitutte/map/point_map.h"

namespace orbitutte {

/// Finds points of the target on the surface: as PointLocator, but it does not tell the copies, and is faster
/// for many points.
///
/// Points are taken along a space-filling curve. From the triangle of one, a walk leads to the next: across
/// any edge that has the point on its far side (a stochastic visibility walk: O. Devillers, S. Pion, M.
/// Teillaud, "Walking in a triangulation", 2002); the signs are exact. Across a seam the walk goes on at the
/// other bank, the point moved by the seam's isometry; at a mirror the point is reflected. Where a walk does
/// not arrive, as in parts that are turned over, PointLocator searches.
class SurfaceWalk {
 public:
  /// In the canonical frame of the target. Keeps a copy of what it needs, but not of `embedding`, to which it
  /// refers.
  explicit SurfaceWalk(const Embedding& embedding);
  ~SurfaceWalk();

  /// Triangles and coordinates of points (k x 3); -1 and NaN where nothing is found. `copy` is empty.
  SurfacePoints locate(const Points& points) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A triangulated sphere (points: unit vectors; triangles counterclockwise from outside) as an embedding of
/// itself.
Embedding embedded_sphere(const Points& points, const Triangles& triangles);

}  // namespace orbitutte
