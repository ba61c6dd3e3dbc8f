// SPDX-License-Identifier: MIT
#include "orbitutte/solve/laplacian_solver.h"

#include <cmath>

#include "orbitutte/geometry/stereographic_chart.h"
#include "orbitutte/linear/laplacian_matrix.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/laplacian_systems.h"

namespace orbitutte {
namespace {

// The banks' dense matrix has up to three rows per bank vertex. It stays cheap beside the sparse factor while
// the banks are, like shortest paths and ordinary boundaries, no longer than some multiple of the square root
// of the mesh.
bool banks_are_short(const CutMesh& cut, std::size_t vertex_count) {
  return static_cast<double>(cut.boundary.size()) <= 200 + 4 * std::sqrt(static_cast<double>(vertex_count));
}

// Along an edge between a position that is not given and one that is, the latter pulls at the former: one row
// a node. position(node) of those given: where the node is.
template <typename IsGiven, typename Position>
Points pull_of_given(const DiskGraph& graph, const Eigen::VectorXd& w, const IsGiven& is_given,
                     const Position& position) {
  Points pull = Points::Zero(graph.node_count(), 3);
  const std::vector<int> pulling = parallel_select(graph.edge_count(), [&](int e) {
    const auto [a, b] = graph.ends(e);
    return is_given(a) != is_given(b);
  });
  for (const int e : pulling) {
    const auto [a, b] = graph.ends(e);
    const int given = is_given(a) ? a : b;
    pull.row(given == a ? b : a) += w[e] * position(given).transpose();
  }
  return pull;
}

}  // namespace

LaplacianSolver::LaplacianSolver(const CutMesh& cut, const GluedEdges& glued, const EdgeWeights& weights,
                                 const BoundaryConditions& boundary, const LaplacianSetup& setup)
    : w_(weights.w),
      glued_(glued),
      is_stiff_(weights.w.size() > 0 && weights.w.maxCoeff() > stiff_weight),
      graph_(std::make_unique<DiskGraph>(disk_graph(cut, glued, boundary))) {
  const std::size_t n = boundary.basis_of.size();
  const std::shared_ptr<LaplacianReuse> reuse = setup.reuse ? setup.reuse : reusable_laplacians(Kept::order);
  if (!reuse->dissection) order_ahead(*reuse, ends(glued), static_cast<int>(n));
  const Dissection dissection = adapted(*reuse->dissection, ends(glued));
  const LaplacianProblem problem = {*graph_, glued, w_, boundary, dissection};
  systems_ = banks_are_short(cut, n) ? banked_systems(problem, setup.options, *reuse)
                                     : coupled_systems(problem, setup.options.backend);
}

std::shared_ptr<LaplacianReuse> reusable_laplacians(Kept kept) {
  auto reuse = std::make_shared<LaplacianReuse>();
  reuse->kept = kept;
  return reuse;
}

void order_ahead(LaplacianReuse& reuse, const std::vector<std::array<int, 2>>& edges, int vertex_count) {
  if (reuse.dissection && reuse.edges == edges) return;
  if (reuse.kept == Kept::factors) reuse.edges = edges;
  reuse.dissection = std::make_shared<Dissection>(dissect(vertex_neighbors(edges, vertex_count)));
}

LaplacianSolver::~LaplacianSolver() = default;
LaplacianSolver::LaplacianSolver(LaplacianSolver&&) noexcept = default;

Points LaplacianSolver::extend_harmonically(const Points& positions) const {
  const DiskGraph& graph = *graph_;
  const Points pull = pull_of_given(
      graph, w_, [&](int node) { return !graph.unknown_at_start(node); },
      [&](int node) -> Vector3 {
        return graph.transform(node) * positions.row(graph.vertex[node]).transpose();
      });
  Points result = systems_->solve_disk(pull).topRows(positions.rows());
  for (Eigen::Index v = 0; v < result.rows(); ++v)
    if (graph.given[v]) result.row(v) = positions.row(v);
  return result;
}

Points LaplacianSolver::settle(const Points& positions, const StereographicChart& chart) const {
  if (!systems_->knows_banks()) return {};
  const DiskGraph& graph = *graph_;
  std::vector<char> moves(graph.node_count(), 0);
  for (int v = 0; v < static_cast<int>(graph.inside.size()); ++v) moves[v] = graph.inside[v];
  for (const int node : graph.banks) moves[node] = 1;
  const Points pull = pull_of_given(
      graph, w_, [&](int node) { return moves[node] == 0; },
      [&](int node) {
        return chart.flat(graph.transform(node) * positions.row(graph.vertex[node]).transpose());
      });
  return systems_->settle(pull, positions, chart);
}

Points LaplacianSolver::glued_laplacian(const Points& x) const {
  Points result = Points::Zero(x.rows(), 3);
  for (std::size_t e = 0; e < glued_.edges.size(); ++e) {
    const auto [i, j, t] = glued_.edges[e];
    const Isometry& g = glued_.transforms[t];
    const Vector3 pull = w_[static_cast<Eigen::Index>(e)] * (Vector3(x.row(i)) - g * Vector3(x.row(j)));
    result.row(i) += pull;
    result.row(j) -= g.inverse() * pull;
  }
  return result;
}

Points LaplacianSolver::precondition(const Points& gradient) const {
  Points result = systems_->solve_glued(gradient);
  if (is_stiff_) result += systems_->solve_glued(gradient - glued_laplacian(result));  // a refinement
  parallel_ranges(static_cast<int>(result.rows()),
                  [&](int begin, int end) { result.middleRows(begin, end - begin) *= 0.5; });
  return result;
}

}  // namespace orbitutte
