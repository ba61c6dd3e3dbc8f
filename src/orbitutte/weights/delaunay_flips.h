// SPDX-License-Identifier: MIT
// Edge flips that make a triangulation intrinsically Delaunay (A. Bobenko, B. Springborn, "A discrete
// Laplace-Beltrami operator for simplicial surfaces", Discrete Comput. Geom. 38 (2007); M. Fisher, B.
// Springborn, A. Bobenko, P. Schroeder, "An algorithm for the construction of intrinsic Delaunay
// triangulations with applications to digital geometry processing", SIGGRAPH courses 2006).
#pragma once

#include <vector>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// The lengths of the edges in space, divided by their mean and then mollified: all grow by the same small
/// number (at most 1e-8), so that every triangle inequality holds with that slack. Triangles without area
/// become thin ones, and nothing else changes (N. Sharp, K. Crane, "A Laplacian for nonmanifold triangle
/// meshes", SGP 2020: intrinsic mollification).
std::vector<double> mollified_lengths(const Surface& surface);

/// Half the cotangent of the angle opposite to the side a of a triangle: (b^2 + c^2 - a^2)/(8 area).
double half_cotangent(double a, double b, double c);

/// tan(angle/2) of the angle opposite to the side a of a triangle.
double half_angle_tangent(double a, double b, double c);

/// Computes half the cotangents of a face's angles anew after its lengths have changed.
void measure_angles(IntrinsicTriangulation& triangulation, int face);

/// The surface's own triangulation, with mollified lengths. All its faces are triangles.
IntrinsicTriangulation intrinsic_triangulation(const Surface& surface);

/// Flips edges until each is Delaunay: its opposite angles add up to at most pi, up to rounding. All edges
/// but the given ones must be Delaunay before. An edge is not flipped if it is on the boundary or belongs to
/// a kept face, if the flip would join two vertices by a second edge or two that are kept apart by any, or if
/// it would leave a boundary vertex with a single face: a vertex of degree two has no place of its own in a
/// Tutte embedding. Takes O(n) time on practical meshes. The faces need not be consistently oriented.
void make_delaunay(IntrinsicTriangulation& triangulation, const std::vector<int>& edges);

/// The same if any edge may not be Delaunay.
void make_delaunay(IntrinsicTriangulation& triangulation);

}  // namespace orbitutte
