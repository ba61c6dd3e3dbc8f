// SPDX-License-Identifier: MIT
// The metric of constant curvature, with given angles at its cones, that is discretely conformal to a
// surface.
#pragma once

#include "orbitutte/geometry/space.h"
#include "orbitutte/linear/dissection.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/options.h"

namespace orbitutte {

/// What angles a surface is to have, and what its linear systems are made of.
struct ConformalProblem {
  /// Closed.
  const Surface& surface;

  /// The sphere or the hyperbolic plane.
  Space space;

  /// n: what the angles around each vertex are to add up to: 2 pi, the angle of a cone, or 0 if no triangle
  /// uses the vertex. By Gauss and Bonnet they decide the area, which must be positive.
  Eigen::VectorXd angles;

  /// Of the Laplacian that preconditions, and a dissection of the graph of its edges.
  const EdgeWeights& weights;
  const Dissection& dissection;
  Backend backend;
};

/// Geodesic triangles, glued along their sides.
struct ConformalMetric {
  /// T x 3: the length of each half-edge.
  Points lengths;

  /// T x 3: the angle at each corner. Where lengths are those of no triangle, it is pi opposite to the
  /// longest and zero at the other corners.
  Points angles;

  /// T: is it such a triangle?
  std::vector<char> is_flat;

  /// The largest difference between the sum of the angles around a vertex and what it is to be.
  double defect = 0;
};

/// Discrete conformal equivalence in curved spaces (A. Bobenko, U. Pinkall, B. Springborn, "Discrete
/// conformal maps and ideal polyhedra", Geometry and Topology 19 (2015), section 6): every vertex has a scale
/// u, and the edge of length l between i and j becomes a geodesic with the chord
///     2 sn(d_ij/2) = exp((u_i + u_j)/2) l_ij.
/// The sums of the angles have a symmetric derivative by u: with the angles a_i, a_j at the ends of a side
/// and a_o opposite to it, each triangle adds to its quadratic form, for each of its sides,
///     w ((v_i - v_j)^2 - k tn^2(d_ij/2) (v_i + v_j)^2),  w = tan((a_i + a_j - a_o)/2)/2,
/// the cotangent Laplacian and what the curvature adds. Newton's method solves for u, step by step with
/// preconditioned conjugate gradients. In the hyperbolic plane the form is that of a convex function. On the
/// sphere it is negative for the constants, apart from which it is positive near the solution.
///
/// The best metric that was found; its defect tells whether it is the one that was wanted. There need not be
/// any for the given triangles.
ConformalMetric conformal_metric(const ConformalProblem& problem);

}  // namespace orbitutte
