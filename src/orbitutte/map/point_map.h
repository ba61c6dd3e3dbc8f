// SPDX-License-Identifier: MIT
// An embedding as a map of points: from the surface to the sphere, and back from anywhere on the tiled
// sphere.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// k points of the copies of a surface.
struct SurfacePoints {
  /// k: triangles, rows of Embedding::triangles; -1 for none.
  std::vector<int> triangle;

  /// k x 3, on the corners of that row, with the sum 1; NaN for none.
  Points barycentric;

  /// k: the copy, an index into the elements of group_of(target); -1 for none. If empty, all points are in
  /// copy 0, which is the embedding itself.
  std::vector<int> copy;

  int count() const { return static_cast<int>(triangle.size()); }
};

/// The images of points (k x 3) in the canonical frame of the target, in which all embeddings into it can be
/// compared: copy g has g times the point of the embedding's triangle. NaN if the triangle is -1. The map is
/// continuous across edges and seams, and takes vertices to Embedding::canonical_positions. Throws
/// ArgumentError naming the point if its triangle or copy does not exist, or if its coordinates are not
/// finite, negative or do not add up to 1 (each to 1e-6).
Points map_points(const Embedding& embedding, const SurfacePoints& points);

/// Finds points of the target in the copies of an embedding's tile.
class PointLocator {
 public:
  /// The number of copies that are searched in the plane, where there are infinitely many.
  static constexpr int default_copies = 100;

  /// Keeps the embedding's positively oriented triangles in a tree, in O(n log n). If the group is infinite,
  /// the `copies` nearest to the tile are searched. Throws ArgumentError if positions are not finite or
  /// indices out of range.
  explicit PointLocator(const Embedding& embedding, int copies = default_copies);
  ~PointLocator();
  PointLocator(PointLocator&&) noexcept;

  /// The triangle and copy that hold each point (k x 3, in the canonical frame of the target; lengths do not
  /// matter): map_points takes them back there. If several copies meet at a point, the first is taken, and
  /// of its triangles the first that holds the point; the signs are exact on the stored numbers. If banks of
  /// seams leave a gap of rounding errors, up to 1e-11, the nearest edge beside the gap is taken. Every
  /// point of the sphere is found if the embedding is certified. Otherwise a point has triangle -1 if no
  /// positively oriented triangle covers it. Points outside of a fixed polygon or outside of the copies
  /// searched have triangle -1, too, and so have vectors that are zero or not finite. O(copies + log n) per
  /// point, on all threads.
  SurfacePoints locate(const Points& points) const;

  /// The copies: the elements of group_of(target).
  const std::vector<Isometry>& elements() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orbitutte
