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
  std::vector<int> face;  ///< k: triangles, rows of Embedding::faces; -1 for none
  Points barycentric;     ///< k x 3, on the corners of that row, with the sum 1; NaN for none
  /// k: the copy, an index into SymmetryGroup::elements of the seams' transforms (and into tile_copies); -1
  /// for none. Empty: all in copy 0, which is the embedding itself.
  std::vector<int> element;

  int count() const { return static_cast<int>(face.size()); }
};

/// The images of points (k x 3): copy g has g of spherical_point in the embedding's triangle; in the plane
/// z = 1 the combination itself. NaN where the face is -1. The map is continuous across edges and seams, and
/// takes vertices to their positions. Throws ArgumentError naming the point whose face or copy does not
/// exist, or whose coordinates are not finite, negative or do not add up to 1 (each to 1e-6).
Points map_points(const Embedding& embedding, const SurfacePoints& points);

/// Finds points on the sphere, in every copy of an embedding's tile.
class PointLocator {
 public:
  /// Keeps the embedding's triangles that are positively oriented in a tree, in O(n log n). Throws
  /// ArgumentError where the embedding is one into the plane, where seams do not generate the group, and
  /// where positions are not finite or indices out of range.
  explicit PointLocator(const Embedding& embedding);
  ~PointLocator();
  PointLocator(PointLocator&&) noexcept;

  /// The triangle and copy that hold each direction (k x 3; lengths do not matter): map_points takes them
  /// back there. Of several copies that meet at a point the first is taken, of several triangles of it the
  /// first, by signs that are exact on the stored numbers; where banks of seams leave a gap of rounding
  /// errors, or up to 1e-11, the nearest edge beside it. Every direction is found where the embedding is
  /// certified. Where it is not, a direction that no positively oriented triangle covers has face -1, and of
  /// several that do the first is taken; outside of a fixed polygon there is none either, nor for a vector
  /// that is zero or not finite. O(|G| + log n) a point, on all threads.
  SurfacePoints locate(const Points& directions) const;

  /// The copies: SymmetryGroup::elements.
  const std::vector<Matrix3>& elements() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace orbitutte
