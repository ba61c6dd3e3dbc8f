// SPDX-License-Identifier: MIT
// Two ways to the two linear systems of LaplacianSolver. Private to solve/.
#pragma once

#include <array>
#include <memory>
#include <vector>

#include "orbitutte/linear/dissection.h"
#include "orbitutte/solve/disk_graph.h"
#include "orbitutte/solve/laplacian_solver.h"

namespace orbitutte {

class Substructure;

/// What a later embedding of the same mesh, with other cones or orders, may use again.
class LaplacianReuse {
 public:
  Kept kept = Kept::order;
  /// Of the graph that was dissected, from which that of a solver may differ in a few edges; none if only
  /// the order is kept, which is then found anew when it is asked for ahead.
  std::vector<std::array<int, 2>> edges;
  /// null: none was.
  std::shared_ptr<const Dissection> dissection;
  /// Of the last cut disk.
  SparseMatrix disk_laplacian;
  std::shared_ptr<const Substructure> disk_factor;
};

/// The glued edges with their weights, as the systems see them.
struct LaplacianProblem {
  const DiskGraph& graph;
  const GluedEdges& glued;
  const Eigen::VectorXd& w;
  const BoundaryConditions& boundary;
  /// Of the graph of the vertices.
  const Dissection& dissection;
};

/// In the start, a node on a bank that is not given is tied to the origin by this fraction of its weights:
/// where every edge of a few vertices crosses the cut, nothing else holds them.
constexpr double weak_tie = 1e-9;

class LaplacianSystems {
 public:
  virtual ~LaplacianSystems() = default;

  /// Solves the scalar Laplacian of the disk's graph, the vertices that are given held at zero; f and the
  /// result: one row a node, of which only those of nodes unknown at the start count.
  virtual Points solve_disk(const Points& f) const = 0;

  /// LaplacianSolver::settle, if it is known how the banks pull; f: one row a node, what held vertices pull
  /// at it in the chart.
  virtual bool knows_banks() const { return false; }
  virtual Points settle(const Points&, const Points& positions, const StereographicChart&) const {
    return positions;
  }

  /// Solves the glued Laplacian; f and the result: n x 3, feasible.
  virtual Points solve_glued(const Points& f) const = 0;
};

/// One factorisation of the cut disk's scalar Laplacian, its banks last. Away from the banks the three
/// coordinates do not couple, so the factor of the inner vertices serves both systems, and the Schur
/// complement S onto the banks (the disk's Dirichlet-to-Neumann matrix) is glued into one small dense matrix
/// N'(S x I3)N. For banks that are short beside the mesh. Uses what it can of the last disk's factor, and
/// leaves its own behind.
std::unique_ptr<LaplacianSystems> banked_systems(const LaplacianProblem& problem,
                                                 const LaplacianOptions& options, LaplacianReuse& reuse);

/// Each system sparse and on its own: a scalar one, and one of up to three unknowns a vertex. For banks of
/// any length.
std::unique_ptr<LaplacianSystems> coupled_systems(const LaplacianProblem& problem, Backend backend);

}  // namespace orbitutte
