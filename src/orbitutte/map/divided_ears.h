// SPDX-License-Identifier: MIT
// Triangles with two edges on one mirror, which a map to a tile with straight sides flattens, divided so that
// none of their parts is flat. Private to map/.
#pragma once

#include <array>
#include <optional>
#include <unordered_map>
#include <vector>

#include "orbitutte/map/point_map.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// A triangle x y z that was divided from the middle m of its edge x y: x m z has its row, m y z a new one.
struct DividedTriangle {
  /// Its row, and its corner x: 0, 1 or 2.
  int row = -1, corner = -1;

  /// The row of m y z, in which y and z are the same corners as in x y z.
  int added = -1;

  /// The vertex m, and the input vertices x, y, z, or middles of triangles that were divided before.
  int middle = -1;
  std::array<int, 3> vertices = {-1, -1, -1};
};

/// An ear has its tip and both ends on one mirror, so that its image has no area. Its inner edge, between the
/// ends, gets a vertex in the middle, which is put a quarter of the way into the triangle behind that edge:
/// with it, both parts of the ear and of that triangle are positive, and all of the surface is mapped one to
/// one. Nothing else of the embedding changes.
class DividedEars {
 public:
  /// Refers to the embedding. An ear stays as it is if a seam runs along its inner edge.
  explicit DividedEars(const Embedding& embedding);

  /// Is any triangle divided?
  bool any() const { return !divisions_.empty(); }

  /// With the parts as triangles, and the middles as the last cut vertices and the last input vertices;
  /// polygons are none. The embedding as it was given, if nothing is divided.
  const Embedding& parts() const { return parts_ ? *parts_ : whole_; }

  /// The middles are no input vertices of the whole.
  bool is_middle(int vertex) const { return any() && vertex >= divisions_.front().middle; }

  /// The half-edge of the inner edge that a middle lies on.
  int halfedge_of_middle(int vertex) const;

  /// The triangle that a part belongs to.
  int whole_triangle(int part) const;

  /// The half-edge that one of a part's lies on; -1 if it runs inside a triangle.
  int whole_halfedge(int halfedge) const;

  /// Points on the whole, as points on the parts, and back.
  SurfacePoints on_parts(SurfacePoints points) const;
  SurfacePoints on_whole(SurfacePoints points) const;

  /// A polyline whose points lie, two by two, in one triangle of the whole: with further points where it goes
  /// from one part to the next. All points must lie in triangles.
  SurfacePoints polyline_on_parts(SurfacePoints points) const;

 private:
  /// Those that a triangle of the whole went through, in their order.
  const std::vector<DividedTriangle>& divisions_of(int whole_triangle) const;

  const Embedding& whole_;
  std::optional<Embedding> parts_;

  /// In the order in which they were made: two for each ear, of whose parts the added rows follow each other.
  std::vector<DividedTriangle> divisions_;

  /// The same by the triangle of the whole that the divided part belongs to.
  std::unordered_map<int, std::vector<DividedTriangle>> divisions_of_;
};

}  // namespace orbitutte
