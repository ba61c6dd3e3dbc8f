// SPDX-License-Identifier: MIT
#include "orbitutte/solve/laplacian_solver.h"

#include <cmath>

#include "orbitutte/parallel.h"
#include "orbitutte/solve/laplacian_systems.h"

namespace orbitutte {
namespace {

std::vector<char> vertices_inside(const CutMesh& cut, const BoundaryConditions& boundary) {
  std::vector<char> inside(boundary.basis_of.size(), 1);
  for (std::size_t v = 0; v < inside.size(); ++v) inside[v] = boundary.basis(static_cast<int>(v)).cols() > 0;
  for (const int v : cut.boundary) inside[cut.source_vertex[v]] = 0;
  return inside;
}

std::vector<std::array<int, 2>> ends(const GluedEdges& glued) {
  std::vector<std::array<int, 2>> result;
  result.reserve(glued.edges.size());
  for (const GluedEdge& edge : glued.edges) result.push_back({edge.i, edge.j});
  return result;
}

// The banks' dense matrix has up to three rows per bank vertex. It stays cheap beside the sparse factor while
// the banks are, like shortest paths and ordinary boundaries, no longer than some multiple of the square root
// of the mesh.
bool banks_are_short(const CutMesh& cut, std::size_t vertex_count) {
  return static_cast<double>(cut.boundary.size()) <= 200 + 4 * std::sqrt(static_cast<double>(vertex_count));
}

}  // namespace

LaplacianSolver::LaplacianSolver(const CutMesh& cut, const GluedEdges& glued, const EdgeWeights& weights,
                                 const BoundaryConditions& boundary, const LaplacianOptions& options)
    : cut_(cut), glued_(glued), w_(weights.w), inside_(vertices_inside(cut, boundary)) {
  const std::shared_ptr<LaplacianReuse> reuse =
      options.reuse ? options.reuse : reusable_laplacians(Kept::order);
  if (!reuse->dissection) order_ahead(*reuse, ends(glued), static_cast<int>(inside_.size()));
  const LaplacianProblem problem = {cut, glued, w_, boundary, inside_, *reuse->dissection};
  systems_ = banks_are_short(cut, inside_.size()) ? banked_systems(problem, options, *reuse)
                                                  : coupled_systems(problem, options.backend);
}

std::shared_ptr<LaplacianReuse> reusable_laplacians(Kept kept) {
  auto reuse = std::make_shared<LaplacianReuse>();
  reuse->kept = kept;
  return reuse;
}

void order_ahead(LaplacianReuse& reuse, const std::vector<std::array<int, 2>>& edges, int vertex_count) {
  if (!reuse.dissection)
    reuse.dissection = std::make_shared<Dissection>(dissect(neighbors(edges, vertex_count)));
}

LaplacianSolver::~LaplacianSolver() = default;
LaplacianSolver::LaplacianSolver(LaplacianSolver&&) noexcept = default;

Eigen::MatrixXd LaplacianSolver::extend_harmonically(const Eigen::MatrixXd& boundary_positions) const {
  Eigen::MatrixXd pull = Eigen::MatrixXd::Zero(boundary_positions.rows(), boundary_positions.cols());
  // An edge between a vertex inside and a given position pulls at the former; edges have two images only
  // along the cut, where both ends are given.
  std::vector<char> done(glued_.edges.size(), 0);
  for (int h = 0; h < static_cast<int>(cut_.F.size()); ++h) {
    const int a = origin(cut_.F, h), b = target(cut_.F, h), e = glued_.edge_of[h];
    if (e < 0) continue;  // a diagonal
    const bool a_inside = inside_[cut_.source_vertex[a]], b_inside = inside_[cut_.source_vertex[b]];
    if (done[e] || a_inside == b_inside) continue;
    done[e] = 1;
    if (a_inside) {
      pull.row(a) += w_[e] * boundary_positions.row(b);
    } else {
      pull.row(b) += w_[e] * boundary_positions.row(a);
    }
  }
  Eigen::MatrixXd result = systems_->solve_disk(pull);
  for (Eigen::Index v = 0; v < result.rows(); ++v)
    if (!inside_[cut_.source_vertex[v]]) result.row(v) = boundary_positions.row(v);
  return result;
}

Points LaplacianSolver::precondition(const Points& gradient) const {
  Points result = systems_->solve_glued(gradient);
  parallel_ranges(static_cast<int>(result.rows()),
                  [&](int begin, int end) { result.middleRows(begin, end - begin) *= 0.5; });
  return result;
}

}  // namespace orbitutte
