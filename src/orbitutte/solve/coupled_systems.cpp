// SPDX-License-Identifier: MIT
#include "orbitutte/linear/laplacian_matrix.h"
#include "orbitutte/solve/laplacian_systems.h"

namespace orbitutte {
namespace {

struct System {
  Unknowns unknowns;
  std::unique_ptr<SparseFactor> factor;
};

// Of the nodes, those in place in the order of the vertices.
System disk_system(const LaplacianProblem& problem, Backend backend) {
  const DiskGraph& graph = problem.graph;
  const Neighbors near = vertex_neighbors(ends(graph), graph.node_count());
  std::vector<int> order = problem.dissection.order, count(graph.node_count());
  for (int node = static_cast<int>(order.size()); node < graph.node_count(); ++node) order.push_back(node);
  for (int node = 0; node < graph.node_count(); ++node)
    count[node] = graph.unknown_at_start(node) && near.start[node] < near.start[node + 1] ? 1 : 0;
  System disk = {number_unknowns(order, std::move(count)), nullptr};
  const auto coupling = [](int, int) { return Block(Block::Identity(1, 1)); };
  SparseMatrix A = assemble(disk.unknowns, near, problem.w, coupling);
  for (const int node : disk.unknowns.order)
    if (!graph.inside[graph.vertex[node]])
      A.coeffRef(disk.unknowns.first[node], disk.unknowns.first[node]) *= 1 + weak_tie;
  disk.factor = factorize_laplacian(A, disk.unknowns, backend);
  return disk;
}

class CoupledSystems : public LaplacianSystems {
 public:
  CoupledSystems(const LaplacianProblem& problem, Backend backend)
      : boundary_(problem.boundary), disk_(disk_system(problem, backend)) {
    const int n = static_cast<int>(problem.graph.inside.size());
    const Neighbors near = vertex_neighbors(ends(problem.glued), n);

    std::vector<int> room(n);
    for (int v = 0; v < n; ++v) room[v] = static_cast<int>(boundary_.basis(v).cols());
    // Edge (i, j, g) couples B_i' g B_j; seen from j, its transpose.
    const auto coupling = [&](int e, int v) -> Block {
      const auto [i, j, t] = problem.glued.edges[e];
      const Matrix3& g = problem.glued.transforms[t].matrix();
      const Block block = boundary_.basis(i).transpose() * g * boundary_.basis(j);
      return v == j ? block : Block(block.transpose());
    };
    coupled_.unknowns = number_unknowns(problem.dissection.order, std::move(room));
    coupled_.factor = factorize_laplacian(assemble(coupled_.unknowns, near, problem.w, coupling),
                                          coupled_.unknowns, backend);
  }

  Points solve_disk(const Points& f) const override {
    Points rhs(disk_.unknowns.total, 3);
    for (const int node : disk_.unknowns.order) rhs.row(disk_.unknowns.first[node]) = f.row(node);
    Points result = Points::Zero(f.rows(), 3);
    if (!disk_.factor) return result;
    const Points x = disk_.factor->solve(rhs);
    for (const int node : disk_.unknowns.order) result.row(node) = x.row(disk_.unknowns.first[node]);
    return result;
  }

  Points solve_glued(const Points& f) const override {
    const Unknowns& unknowns = coupled_.unknowns;
    Points result = Points::Zero(f.rows(), 3);
    if (!coupled_.factor) return result;
    Eigen::VectorXd rhs(unknowns.total);
    for (const int v : unknowns.order)
      rhs.segment(unknowns.first[v], unknowns.count[v]) =
          boundary_.basis(v).transpose() * f.row(v).transpose();
    const Eigen::VectorXd x = coupled_.factor->solve(rhs);
    for (const int v : unknowns.order)
      result.row(v) = boundary_.basis(v) * x.segment(unknowns.first[v], unknowns.count[v]);
    return result;
  }

 private:
  const BoundaryConditions& boundary_;
  System disk_;     // one unknown for each node of the disk's graph that is unknown at the start
  System coupled_;  // up to three for each vertex that may move
};

}  // namespace

std::unique_ptr<LaplacianSystems> coupled_systems(const LaplacianProblem& problem, Backend backend) {
  return std::make_unique<CoupledSystems>(problem, backend);
}

}  // namespace orbitutte
