// SPDX-License-Identifier: MIT
// The minimum of the energy over a few vertices, the others held.
#pragma once

#include <Eigen/SparseCholesky>
#include <unordered_map>
#include <vector>

#include "orbitutte/solve/movable_positions.h"

namespace orbitutte {

/// What a vertex sees along its edges.
struct Neighbourhood {
  int vertex = -1;
  std::vector<Neighbour> neighbours;
};

/// One sparse factor of the energy's Hessian, in doubles, serves for as many digits as the positions have:
/// forces are summed with all of them, and each step gains some ten digits. Where the map is flat on the
/// scale of its edges, the Hessian is the Laplacian (up to a factor two); long edges in a curved space are
/// stiffer or softer across than along.
class LocalMinimum {
 public:
  /// One neighbourhood of each vertex that may move, ascending; held vertices among them stay where they are.
  LocalMinimum(const Gluing& gluing, const MovablePositions& positions,
               std::vector<Neighbourhood> neighbourhoods);

  /// What a step does to the edges: the largest change of one, relative to its length before, and how many
  /// change so much that they have not settled.
  struct Change {
    double largest = 0;
    int unsettled = 0;

    /// The largest step of a vertex, relative to the shortest of its edges.
    double shift = 0;
  };

  /// One Newton step, with that error of d/sn d.
  Change step(MovablePositions& positions, double error = 1e-15) const;

  /// Steps until edges change by small parts of their lengths only. Did that come about?
  bool settle(MovablePositions& positions) const;

  /// Steps until all vertices move by small parts of their shortest edges only, so that also what is far
  /// smaller than its surroundings lies where these hold it. Did that come about?
  bool settle_in_place(MovablePositions& positions) const;

 private:
  using Basis = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 2>;

  Basis basis_at(const Vector3& p, int vertex) const;
  Change change_by(const MovablePositions& positions, const std::vector<Vector3>& steps) const;
  double shortest_edge(const MovablePositions& positions) const;

  Gluing gluing_;
  Space space_;
  std::vector<Neighbourhood> neighbourhoods_;
  /// Of a vertex among them.
  std::unordered_map<int, int> place_;
  /// Of the tangent plane and the room of each vertex.
  std::vector<Basis> bases_;
  /// The first unknown of each vertex, and the number of all.
  std::vector<int> first_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor_;
};

}  // namespace orbitutte
