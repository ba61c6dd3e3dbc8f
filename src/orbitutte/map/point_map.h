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

  /// k: the copy, an index into the elements of group_of(target); -1 for none. Empty: all in copy 0, which is
  /// the embedding itself.
  std::vector<int> copy;

  int count() const { return static_cast<int>(triangle.size()); }
};

/// The images of points (k x 3) in the canonical frame of the target, in which all embeddings into it can be
/// compared: copy g has g times the point of the embedding's triangle. NaN where the triangle is -1. The map
/// is continuous across edges and seams, and takes vertices to Embedding::canonical_positions. Throws
/// ArgumentError naming the point whose triangle or copy does not exist, or whose coordinates are not finite,
/// negative or do not add up to 1 (each to 1e-6).
Points map_points(const Embedding& embedding, const SurfacePoints& points);

/// Finds points of the target in the copies of an embedding's tile.
class PointLocator {
 public:
  /// So many copies are searched in the plane, where there are infinitely many.
  static constexpr int default_copies = 100;

  /// Keeps the embedding's triangles that are positively oriented in a tree, in O(n log n). Of an infinite
  /// group the copies nearest to the tile are searched, `copies` in number. Throws ArgumentError if positions
  /// are not finite or indices out of range.
  explicit PointLocator(const Embedding& embedding, int copies = default_copies);
  ~PointLocator();
  PointLocator(PointLocator&&) noexcept;

  /// The triangle and copy that hold each point (k x 3, in the canonical frame of the target; lengths do not
  /// matter): map_points takes them back there. Of several copies that meet at a point the first is taken, of
  /// several triangles of it the first, by signs that are exact on the stored numbers; where banks of seams
  /// leave a gap of rounding errors, or up to 1e-11, the nearest edge beside it. Every point of the sphere is
  /// found if the embedding is certified. If it is not, a point that no positively oriented triangle covers
  /// has triangle -1, and of several that do the first is taken; outside of a fixed polygon and of the copies
  /// searched there is none either, nor for a vector that is zero or not finite. O(copies + log n) a point,
  /// on all threads.
  SurfacePoints locate(const Points& points) const;

  /// The copies: the elements of group_of(target).
  const std::vector<Isometry>& elements() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orbitutte
