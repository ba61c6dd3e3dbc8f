// SPDX-License-Identifier: MIT
// Edge flips that lead to the intrinsic Delaunay triangulation (A. Bobenko, B. Springborn, "A discrete
// Laplace-Beltrami operator for simplicial surfaces", Discrete Comput. Geom. 38 (2007); M. Fisher, B.
// Springborn, A. Bobenko, P. Schroeder, "An algorithm for the construction of intrinsic Delaunay
// triangulations with applications to digital geometry processing", SIGGRAPH courses 2006).
#pragma once

#include <vector>

#include "orbitutte/mesh/intrinsic_triangulation.h"

namespace orbitutte {

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
/// would join two vertices by a second edge or two that are kept apart by any, or leave a vertex of the
/// boundary with a single face: a vertex of degree two has no place of its own in a Tutte embedding. Edges of
/// the boundary stay. Takes O(n) time on meshes as they are. The faces need not have consistent orientations.
void make_delaunay(IntrinsicTriangulation& triangulation, const std::vector<int>& edges);

}  // namespace orbitutte
