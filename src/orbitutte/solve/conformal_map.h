// SPDX-License-Identifier: MIT
// The shape of a tile in the plane and the harmonic map onto it, together: of all shapes, the one for which
// the map is conformal.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/solve/placement.h"

namespace orbitutte {

/// Minimises the energy (2) over the positions and the shapes of the tile, the tile's area held: positions of
/// the input vertices (n x 3), the first mark at (0, 0, 1), for the tile that tile_through makes of them,
/// whose area is target_area.
///
/// Positions z and shapes p are linear in each other: the gluings depend on p by their translations alone. Of
/// the harmonic maps z_j onto the tiles of a basis of shapes, one solution of the Laplacian each, S_jk is the
/// Hermitian form of the energy and A_jk that of the area. The largest eigenvalue m of A v = m S v belongs to
/// the combination of least energy for its area: E/2A = 1/2m, which is 1 for conformal maps. Where all angles
/// are at most 2 pi (pi at corners), A has one positive eigenvalue (Thurston), so the minimum is the only
/// one.
///
/// Greater angles have more: as many eigenvalues approach that of conformal maps as there are turns in
/// excess, since maps with poles at such a cone are as conformal everywhere else. Of that eigenspace, the map
/// is taken that has the least energy, for its area, around the cones of greater angles.
///
/// problem: its tile is any of the target's. laplacian: of this problem.
Points conformal_map(const GluingProblem& problem, const LaplacianSolver& laplacian);

/// The harmonic maps onto the tiles of a basis of shapes. A shape is the complex numbers x + iy of the marks,
/// in the order of CutMesh::marks.
class ConformalShapes {
 public:
  /// Solves the Laplacian once for each shape. `problem` must outlive this.
  ConformalShapes(const GluingProblem& problem, const LaplacianSolver& laplacian);
  ~ConformalShapes();
  ConformalShapes(ConformalShapes&&) noexcept;

  /// That of conformal_map, its size such that the tile has the area of the target.
  Eigen::VectorXcd own_shape() const;

  const TileShapes& shapes() const;

  /// The shape in the size at which the tile has the area of the target.
  Eigen::VectorXcd scaled(const Eigen::VectorXcd& shape) const;

  /// The harmonic map onto the tile of a shape without closing defects: positions of the input vertices (n x
  /// 3).
  Points map_onto(const Eigen::VectorXcd& shape) const;

  friend Eigen::VectorXcd shared_shape(const std::vector<const ConformalShapes*>& surfaces,
                                       const std::vector<Eigen::MatrixXcd>& changes);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The shape of the tile that several surfaces are mapped onto with the least sum of their energies: by the
/// sum of their forms S, since their forms A are the same. Where its marks lie at p, those of surface s lie
/// at changes[s] * p. The targets of all are the same, and so are the places of the marks in their cuts.
Eigen::VectorXcd shared_shape(const std::vector<const ConformalShapes*>& surfaces,
                              const std::vector<Eigen::MatrixXcd>& changes);

}  // namespace orbitutte
