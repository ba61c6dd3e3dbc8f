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
  /// The half-edge ab in the face of k: next(h) is bk, previous(h) is ka.
  int h = -1;
  /// The half-edge ab or ba in the face of l: previous(g) begins at l.
  int g = -1;
  /// The other half-edges of the face of l, in either direction.
  int al = -1, lb = -1;
  /// The half-edges opposite to them; -1 on the boundary.
  int beyond_al = -1, beyond_lb = -1;
};

/// Faces on the vertices of a mesh whose edges are geodesics of its surface. Connectivity::edges keeps the
/// numbers of the mesh's edges: a flipped edge keeps its number, and its ends are in no order. Each face has
/// its own unit of length, so two faces beside an edge need not agree on its length. Angles, flips and
/// cotangents do not depend on the unit.
struct IntrinsicTriangulation {
  /// m x 3.
  Triangles F;
  /// Of F.
  Connectivity connectivity;
  /// 3 m: of every half-edge, in its face's unit; empty with weights that cannot be sharpened.
  std::vector<double> length;
  /// 3 m: of the angle opposite to every half-edge; empty with such weights.
  std::vector<double> half_cotangent;
  /// The flips that lead here from the mesh, in this order.
  std::vector<Flip> flips;
  /// Faces of the mesh none of whose edges is flipped.
  std::vector<int> kept_faces;
  /// Pairs of vertices that no flip joins by an edge.
  std::vector<std::array<int, 2>> kept_apart = {};
};

}  // namespace orbitutte
