// SPDX-License-Identifier: MIT
// The two linear systems of the method: the planar Tutte embedding of the start, and the glued Laplacian that
// preconditions the optimiser (appendix B, algorithm 1).
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/linear/sparse_factor.h"
#include "orbitutte/options.h"
#include "orbitutte/solve/dirichlet_energy.h"
#include "orbitutte/solve/preconditioner.h"

namespace orbitutte {

class LaplacianReuse;

/// How the linear systems are solved, and what is there already.
struct LaplacianSetup {
  LaplacianOptions options;

  /// What earlier solvers of the same mesh and weights left behind, to be used again where it fits; none
  /// where null. Results do not depend on it.
  std::shared_ptr<LaplacianReuse> reuse;
};

/// What solvers leave behind for later ones: the elimination order alone, or factors of the last cut mesh,
/// too, which take memory.
enum class Kept { order, factors };

/// Something for LaplacianSetup::reuse that is still empty.
std::shared_ptr<LaplacianReuse> reusable_laplacians(Kept kept);

/// Finds the elimination order, which depends on nothing but the edges that have weights, where `reuse` does
/// not have it yet: so that it can be done while the mesh is cut. The edges that have weights in the end may
/// differ from these in a few places; then the order is adapted to them.
void order_ahead(LaplacianReuse& reuse, const std::vector<std::array<int, 2>>& edges, int vertex_count);

struct DiskGraph;
class LaplacianSystems;
class StereographicChart;

class LaplacianSolver : public Preconditioner {
 public:
  /// Orders the mesh and factorises both systems. The arguments must outlive the solver.
  /// Throws MeshError naming a vertex that no positive weight ties to the cones.
  LaplacianSolver(const CutMesh& cut, const GluedEdges& glued, const EdgeWeights& weights,
                  const BoundaryConditions& boundary, const LaplacianSetup& setup = {});
  ~LaplacianSolver() override;
  LaplacianSolver(LaplacianSolver&&) noexcept;

  /// The discrete harmonic map of the cut disk in space: of the positions (n x 3), those of vertices on the
  /// boundary of the cut mesh are given, and all others are completed so that each is the weighted mean of
  /// its neighbours, seen through the gluing where these are given. A node that is added where an edge
  /// crosses the cut ties only the other neighbours of that edge's end. Any projection of the result is as
  /// harmonic.
  Points extend_harmonically(const Points& positions) const;

  /// A start that is nearly conformal: in the chart, the discrete harmonic map of the cut disk. Its banks
  /// move from `positions` (n x 3, those on the cut's boundary given) to where what both sides of a seam pull
  /// at its vertices balances. Returns the picture of all vertices (n x 3; of held ones: zero), or nothing if
  /// the banks are so long that their own matrix is not known.
  Points settle(const Points& positions, const StereographicChart& chart) const;

  /// P g, where P is the inverse of 2 L, and L the Laplacian glued across the cut, on the unknowns of the
  /// boundary conditions: the Hessian of E where the map is nearly flat. g and the result: n x 3, feasible.
  Points precondition(const Points& gradient) const override;

 private:
  /// L x, before it is projected onto the unknowns of the boundary conditions. x and the result: n x 3.
  Points glued_laplacian(const Points& x) const;

  const Eigen::VectorXd& w_;
  const GluedEdges& glued_;
  /// Are there weights for which single precision does not suffice?
  bool is_stiff_;
  std::unique_ptr<const DiskGraph> graph_;
  std::unique_ptr<LaplacianSystems> systems_;
};

}  // namespace orbitutte
