// SPDX-License-Identifier: MIT
// The metric of constant curvature, with given angles at its cones, that is discretely conformal to a
// surface.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/geometry/space.h"
#include "orbitutte/linear/dissection.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/options.h"

namespace orbitutte {

/// A geodesic triangle by its sides. Side i runs from corner i to corner i + 1.
struct TriangleAngles {
  /// At each corner.
  std::array<double, 3> angle = {};

  /// Of each side, what couples the scales of its ends: w, see conformal_metric.
  std::array<double, 3> coupling = {};

  /// Are the sides those of no triangle? Then the angle is pi opposite to the longest and zero at the other
  /// corners, and the couplings are zero.
  bool is_flat = false;
};

/// half_sn: sn of half of each side; k: the curvature.
TriangleAngles triangle_angles(int k, const std::array<double, 3>& half_sn);

/// What angles a surface is to have, and what its linear systems are made of.
struct ConformalProblem {
  /// A sphere or a disk.
  const Surface& surface;

  /// The sphere or the hyperbolic plane.
  Space space;

  /// n: what the angles around each vertex are to add up to: 2 pi, pi on the boundary, the angle of a mark,
  /// or 0 if no triangle uses the vertex. By Gauss and Bonnet they decide the area, which must be positive.
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

  /// T x 3: the angle at each corner.
  Points angles;

  /// T: are its lengths those of no triangle (TriangleAngles)?
  std::vector<char> is_flat;

  /// The differences between the sums of the angles around the vertices and what they are to be, added up:
  /// what a walk around all of them may be off by.
  double defect = 0;
};

/// Discrete conformal equivalence in curved spaces (A. Bobenko, U. Pinkall, B. Springborn, "Discrete
/// conformal maps and ideal polyhedra", Geometry and Topology 19 (2015)): every vertex has a scale u, and the
/// edge of length l between i and j becomes a geodesic with the chord
///     2 sn(d_ij/2) = exp((u_i + u_j)/2) l_ij.
/// The sums of the angles have a symmetric derivative by u: with the angles a_i, a_j at the ends of a side
/// and a_o opposite to it, each triangle adds to its quadratic form, for each of its sides,
///     w ((v_i - v_j)^2 - k tn^2(d_ij/2) (v_i + v_j)^2),  w = tan((a_i + a_j - a_o)/2)/2,
/// the cotangent Laplacian and what the curvature adds. Newton's method solves for u, step by step with
/// preconditioned conjugate gradients. In the hyperbolic plane the form is that of a convex function. On the
/// sphere it is negative for the constants, apart from which it is positive near the solution; there the area
/// grows in steps, all deficits of angles being scaled.
///
/// The best metric that was found; its defect tells whether it is the one that was wanted. There need not be
/// any for the given triangles.
ConformalMetric conformal_metric(const ConformalProblem& problem);

}  // namespace orbitutte
