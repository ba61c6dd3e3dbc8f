// SPDX-License-Identifier: MIT
// The gluing of the cut mesh's boundary (equations (3), (4) and (7)), as one unknown per input vertex.
#pragma once

#include <vector>

#include "orbitutte/cut/cut.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/tile.h"

namespace orbitutte {

/// The room in which an input vertex may move: position = basis * unknowns, in the plane position = any
/// feasible one + basis * unknowns.
using Basis = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// The first two of BoundaryConditions::bases: all of space, and no room at all.
constexpr int in_space = 0, held_in_place = 1;

/// Every cut vertex is a symmetry's image of one input vertex: position(v) = transform(v) *
/// position(source(v)), so the cut is a choice of gauge and the unknowns do not know where it runs. Input
/// vertex v is cut vertex v.
struct BoundaryConditions {
  std::vector<std::vector<int>>
      sides;  ///< of the tile: the cut vertices from each corner to the next, both included
  std::vector<Seam> seams;
  std::vector<ConeCopies> cones;
  std::vector<Matrix3> transforms;  ///< distinct; the first is the identity
  std::vector<int> transform_of;    ///< n_cut: an index into transforms
  std::vector<Basis> bases;   ///< distinct; 0: all of space (3 x 3) or of the plane (3 x 2), 1: held in place
                              ///< (3 x 0), others: mirror planes (3 x 2) or lines (3 x 1)
  std::vector<int> basis_of;  ///< n: an index into bases
  Points held;                ///< n x 3: where the vertices of basis 1 are held; zero elsewhere

  const Matrix3& transform(int cut_vertex) const { return transforms[transform_of[cut_vertex]]; }
  const Basis& basis(int vertex) const { return bases[basis_of[vertex]]; }

  /// Positions of all cut vertices from those of the input vertices.
  Points spread(const Points& positions, const std::vector<int>& source_vertex) const;
};

/// The place of a matrix among distinct ones (to 1e-9), appended where it is new.
int index_among(std::vector<Matrix3>& distinct, const Matrix3& matrix);

/// Seams, cones and unknowns for a cut mesh whose boundary meets its marks as the tile's corners do. Vertices
/// that no face uses are held at the north pole.
BoundaryConditions glue(const CutMesh& cut, const Tile& tile, const Orbifold& orbifold);

}  // namespace orbitutte
