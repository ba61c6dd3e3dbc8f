// SPDX-License-Identifier: MIT
#include "orbitutte/solve/laplacian_matrix.h"
#include "orbitutte/solve/laplacian_systems.h"

namespace orbitutte {
namespace {

struct System {
  Unknowns unknowns;
  std::unique_ptr<SparseFactor> factor;
};

std::vector<std::array<int, 2>> ends(const GluedEdges& glued) {
  std::vector<std::array<int, 2>> result;
  result.reserve(glued.edges.size());
  for (const GluedEdge& edge : glued.edges) result.push_back({edge.i, edge.j});
  return result;
}

class CoupledSystems : public LaplacianSystems {
 public:
  CoupledSystems(const LaplacianProblem& problem, Backend backend) : boundary_(problem.boundary) {
    const int n = static_cast<int>(problem.inside.size());
    const Neighbors near = neighbors(ends(problem.glued), n);
    disk_.unknowns =
        number_unknowns(problem.dissection.order, {problem.inside.begin(), problem.inside.end()});
    disk_.factor = factorize_laplacian(
        assemble(disk_.unknowns, near, problem.w, [](int, int) { return Block(Block::Identity(1, 1)); }),
        disk_.unknowns, backend);

    std::vector<int> room(n);
    for (int v = 0; v < n; ++v) room[v] = static_cast<int>(boundary_.basis(v).cols());
    // Edge (i, j, g) couples B_i' g B_j; seen from j, its transpose.
    const auto coupling = [&](int e, int v) -> Block {
      const auto [i, j, t] = problem.glued.edges[e];
      const Matrix3& g = problem.glued.transforms[t];
      return v == j ? Block(boundary_.basis(i).transpose() * g * boundary_.basis(j))
                    : Block(boundary_.basis(j).transpose() * g.transpose() * boundary_.basis(i));
    };
    coupled_.unknowns = number_unknowns(problem.dissection.order, std::move(room));
    coupled_.factor = factorize_laplacian(assemble(coupled_.unknowns, near, problem.w, coupling),
                                          coupled_.unknowns, backend);
  }

  Eigen::MatrixXd solve_disk(const Eigen::MatrixXd& f) const override {
    Eigen::MatrixXd rhs(disk_.unknowns.total, f.cols());
    for (const int v : disk_.unknowns.order) rhs.row(disk_.unknowns.first[v]) = f.row(v);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(f.rows(), f.cols());
    if (!disk_.factor) return result;
    const Eigen::MatrixXd x = disk_.factor->solve(rhs);
    for (const int v : disk_.unknowns.order) result.row(v) = x.row(disk_.unknowns.first[v]);
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
  System disk_;     // one unknown for each vertex inside the cut disk
  System coupled_;  // up to three for each vertex that may move
};

}  // namespace

std::unique_ptr<LaplacianSystems> coupled_systems(const LaplacianProblem& problem, Backend backend) {
  return std::make_unique<CoupledSystems>(problem, backend);
}

}  // namespace orbitutte
