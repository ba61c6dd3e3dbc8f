// SPDX-License-Identifier: MIT
// Half-edges of faces of any number of corners.
#pragma once

#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// Half-edge c runs from corner c to the next corner of the same face; corners are numbered face after face.
struct PolygonTopology {
  /// Of every half-edge: a vertex.
  std::vector<int> origin;
  /// Of every half-edge.
  std::vector<int> face_of;
  /// The first corner of every face, and the number of corners.
  std::vector<int> face_start;
  /// The half-edge on the other side, or -1 on the boundary.
  std::vector<int> twin;

  int corner_count() const { return static_cast<int>(origin.size()); }
  int face_count() const { return static_cast<int>(face_start.size()) - 1; }
  int degree(int f) const { return face_start[f + 1] - face_start[f]; }
  int next(int c) const { return c + 1 < face_start[face_of[c] + 1] ? c + 1 : face_start[face_of[c]]; }
  int previous(int c) const { return c > face_start[face_of[c]] ? c - 1 : face_start[face_of[c] + 1] - 1; }
  int target(int c) const { return origin[next(c)]; }
};

/// Of faces that have passed `inspect`, in O(c log c).
PolygonTopology topology_of(const FaceView& faces);

/// Of every vertex: 1 on the boundary.
std::vector<char> boundary_vertices(const PolygonTopology& surface, int vertex_count);

}  // namespace orbitutte
