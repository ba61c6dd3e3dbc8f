// SPDX-License-Identifier: MIT
// Triangulations of a surface by geodesics, known by their edge lengths alone.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// A flip of the edge (a, b) between the faces (a, b, k) and (a, b, l), by the half-edges before it. Faces
/// may run along the edge in the same direction. Afterwards h, next(h), previous(h) are lk, ka, al, and g,
/// next(g), previous(g) are kl, lb, bk.
struct Flip {
  /// Ab, in the face of k: next(h) is bk, previous(h) is ka.
  int h = -1;
  /// Ab or ba, in the face of l: previous(g) begins at l.
  int g = -1;
  /// The other half-edges of that face, in either direction,.
  int al = -1, lb = -1;
  /// And those opposite to them, -1 on the boundary.
  int beyond_al = -1, beyond_lb = -1;
};

/// Faces on the vertices of a mesh whose edges are geodesics of its surface. Connectivity::edges keeps the
/// numbers of the mesh's edges, each flipped edge the one that it had before; its ends are in no order. Each
/// face has its own unit of length: two faces beside an edge need not agree on its length, only on what is
/// similar, and angles, flips and cotangents know no more.
struct IntrinsicTriangulation {
  /// M x 3.
  Triangles F;
  /// Of F.
  Connectivity connectivity;
  /// 3 m: of every half-edge, in its face's unit.
  std::vector<double> length;
  /// 3 m: of the angle opposite to every half-edge.
  std::vector<double> half_cotangent;
  /// That lead here from the mesh, in this order.
  std::vector<Flip> flips;
  /// Of the mesh: none of their edges is flipped.
  std::vector<int> kept_faces;
  /// Vertices that no flip joins by an edge.
  std::vector<std::array<int, 2>> kept_apart = {};
};

}  // namespace orbitutte
