// SPDX-License-Identifier: MIT
// The discrete Dirichlet energy of maps into a space of constant curvature (equation (2)) and its gradient.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/solve/boundary_conditions.h"
#include "orbitutte/solve/elements.h"

namespace orbitutte {

/// An undirected edge of the uncut mesh with its gluing: the neighbour of i is transforms[t] * (position of
/// j).
struct GluedEdge {
  int i = 0, j = 0;
  /// An index into GluedEdges::transforms; 0 is the identity.
  int t = 0;
};

/// The edges of the energy, each with the group element that is applied to its second end.
struct GluedEdges {
  /// In the order of Connectivity::edges.
  std::vector<GluedEdge> edges;
  /// Distinct elements of G; the first is the identity.
  std::vector<Isometry> transforms;
};

/// The group element of every edge: that of one of its images in the cut mesh.
GluedEdges glued_edges(const CutMesh& cut, const Connectivity& connectivity,
                       const BoundaryConditions& boundary);

/// E(p) = sum over edges of w_ij d(p_i, g_ij p_j)^2, with d the distance of the space (see
/// Curvature::distance).
class DirichletEnergy {
 public:
  DirichletEnergy(const GluedEdges& glued, const EdgeWeights& weights, const BoundaryConditions& boundary);

  struct Value {
    double energy = 0;
    /// n x 3: the covectors whose ordinary products with tangent vectors are the derivatives of E.
    /// Tangential, but for the sign of z in the hyperbolic plane, and feasible (along mirrors; zero where
    /// held).
    Points gradient;
  };

  /// positions: n x 3, points of the space. The same bits whatever the number of threads.
  Value evaluate(const Points& positions) const;

  /// The same, into a value whose memory is used again.
  void evaluate(const Points& positions, Value& value) const;

  /// Projects vectors (n x 3) onto the room of their vertices: along mirrors; zero where held.
  void make_feasible(Points& vectors) const;

  /// The vertex with the shortest edge, and that edge's length.
  std::pair<int, double> smallest_spot(const Points& positions) const;

  /// The length of the shortest edge of every vertex (n).
  std::vector<double> shortest_edges(const Points& positions) const;

  /// What a vertex sees along its edges; the elements that it needs are put into `elements`.
  std::vector<Neighbour> neighbours(int vertex, Elements& elements) const;

  Space space() const { return space_; }

  /// GluedEdges::transforms.
  const std::vector<Isometry>& transforms() const { return transforms_; }

  /// How exactly the gradient can be known in double precision: per vertex, the rounding error of a position
  /// of length one times the sum of its weights. n.
  const Eigen::VectorXd& rounding_floor() const { return rounding_floor_; }

 private:
  /// One end of an edge, seen from the other.
  struct Incidence {
    /// transform: 2 t for g, 2 t + 1 for its inverse.
    int neighbor, transform;
    double w;
  };

  // Where the vertex sees its neighbour.
  Vector3 image(const Points& p, const Incidence& incidence) const;
  // The same of a neighbour at q behind a seam.
  Vector3 moved(const Vector3& q, const Incidence& incidence) const;

  // The tangential, feasible part of sum over j of w_ij d/sn d (g_ij p_j - p_i) at vertex i.
  struct Pull {
    Vector3 force;
    /// Sum of w d^2.
    double energy;
  };
  template <int k>
  Pull pull_at(const Points& p, int v) const;

  Space space_;
  std::vector<Isometry> transforms_;
  /// Onto the room of each vertex, by BoundaryConditions::basis_of.
  std::vector<Matrix3> projectors_;
  std::vector<int> basis_of_;
  /// Incidences of vertex v: start_[v] .. start_[v + 1] - 1.
  std::vector<int> start_;
  std::vector<Incidence> incidences_;
  Eigen::VectorXd rounding_floor_;
};

}  // namespace orbitutte
