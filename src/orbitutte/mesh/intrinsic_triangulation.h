// SPDX-License-Identifier: MIT
// Triangulations of a surface by geodesics, known by their edge lengths alone, and the edge flips that lead
// to the intrinsic Delaunay triangulation (A. Bobenko, B. Springborn, "A discrete Laplace-Beltrami operator
// for simplicial surfaces", Discrete Comput. Geom. 38 (2007); M. Fisher, B. Springborn, A. Bobenko, P.
// Schroeder, "An algorithm for the construction of intrinsic Delaunay triangulations with applications to
// digital geometry processing", SIGGRAPH courses 2006).
#pragma once

#include <vector>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// A flip of the edge (a, b) between the faces (a, b, k) and (a, b, l), by the half-edges before it. Faces
/// may run along the edge in the same direction. Afterwards h, next(h), previous(h) are lk, ka, al, and g,
/// next(g), previous(g) are kl, lb, bk.
struct Flip {
  int h = -1;                          ///< ab, in the face of k: next(h) is bk, previous(h) is ka
  int g = -1;                          ///< ab or ba, in the face of l: previous(g) begins at l
  int al = -1, lb = -1;                ///< the other half-edges of that face, in either direction,
  int beyond_al = -1, beyond_lb = -1;  ///< and those opposite to them, -1 on the boundary
};

/// Faces on the vertices of a mesh whose edges are geodesics of its surface. Connectivity::edges keeps the
/// numbers of the mesh's edges, each flipped edge the one that it had before; its ends are in no order. Each
/// face has its own unit of length: two faces beside an edge need not agree on its length, only on what is
/// similar, and angles, flips and cotangents know no more.
struct IntrinsicTriangulation {
  Faces F;                             ///< m x 3
  Connectivity connectivity;           ///< of F
  std::vector<double> length;          ///< 3 m: of every half-edge, in its face's unit
  std::vector<double> half_cotangent;  ///< 3 m: of the angle opposite to every half-edge
  std::vector<Flip> flips;             ///< that lead here from the mesh, in this order
  std::vector<int> kept_faces;         ///< of the mesh: none of their edges is flipped
};

/// The lengths of the edges in space, divided by their mean, and all longer by one small number (at most
/// 1e-8), so that every triangle inequality holds by that much: triangles without area become thin ones, and
/// nothing else changes (N. Sharp, K. Crane, "A Laplacian for nonmanifold triangle meshes", SGP 2020:
/// intrinsic mollification).
std::vector<double> mollified_lengths(const Mesh& mesh, const Connectivity& connectivity);

/// Half the cotangent of the angle opposite to the side a of a triangle: (b^2 + c^2 - a^2)/(8 area).
double half_cotangent(double a, double b, double c);

/// tan(angle/2) of the angle opposite to the side a of a triangle.
double half_angle_tangent(double a, double b, double c);

/// Half the cotangents of a face's angles anew, after its lengths changed.
void measure_angles(IntrinsicTriangulation& triangulation, int face);

/// The mesh's own triangulation, with mollified lengths.
IntrinsicTriangulation intrinsic_triangulation(const Mesh& mesh, const Connectivity& connectivity);

/// Flips edges until each is Delaunay: the angles opposite to it add up to pi at most (but for rounding). All
/// but the given edges are Delaunay before. An edge stays as it is where a kept face has it, where its flip
/// would join two vertices by a second edge, or leave a vertex of the boundary with a single face: a vertex
/// of degree two has no place of its own in a Tutte embedding. Edges of the boundary stay. Takes O(n) time on
/// meshes as they are. The faces need not have consistent orientations.
void make_delaunay(IntrinsicTriangulation& triangulation, const std::vector<int>& edges);

}  // namespace orbitutte
