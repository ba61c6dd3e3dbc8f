// SPDX-License-Identifier: MIT
// Both systems are Laplacians of one graph; they differ in the room of each vertex: one unknown inside the
// disk, or up to three glued ones. Both are assembled in one fill-reducing order of the vertices, found once.
#include "orbitutte/solve/laplacian_solver.h"

#include <fmt/format.h>

#include <algorithm>

namespace orbitutte {
namespace {

using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

std::vector<std::array<int, 2>> ends(const GluedEdges& glued) {
  std::vector<std::array<int, 2>> result;
  result.reserve(glued.edges.size());
  for (const GluedEdge& edge : glued.edges) result.push_back({edge.i, edge.j});
  return result;
}

// The unknowns of all vertices, numbered in the order of elimination.
struct Unknowns {
  std::vector<int> order;   // vertices with at least one unknown
  std::vector<long> first;  // of each vertex; -1 where there are none
  std::vector<int> count;   // of each vertex: 0 to 3
  long total = 0;
};

Unknowns number_unknowns(const std::vector<int>& order, std::vector<int> count) {
  Unknowns unknowns;
  unknowns.first.assign(count.size(), -1);
  for (const int v : order) {
    if (count[v] == 0) continue;
    unknowns.order.push_back(v);
    unknowns.first[v] = unknowns.total;
    unknowns.total += count[v];
  }
  unknowns.count = std::move(count);
  return unknowns;
}

// The lower triangle of the Laplacian sum of w |x_i - g x_j|^2 over the edges, in blocks: `coupling(e, v)` is
// the block that edge e puts into the rows of its other end and the columns of v, without the factor -w.
template <typename Coupling>
SparseMatrix assemble(const Unknowns& unknowns, const Neighbors& near, const Eigen::VectorXd& w,
                      const Coupling& coupling) {
  SparseMatrix A(unknowns.total, unknowns.total);
  const auto later = [&](int v, int u) { return unknowns.first[u] > unknowns.first[v]; };
  long nonzeros = 0;
  for (const int v : unknowns.order) {
    int rows = 0;
    for (int k = near.start[v]; k < near.start[v + 1]; ++k)
      if (later(v, near.neighbor[k])) rows += unknowns.count[near.neighbor[k]];
    for (int c = 0; c < unknowns.count[v]; ++c) {
      A.outerIndexPtr()[unknowns.first[v] + c] = nonzeros;
      nonzeros += unknowns.count[v] - c + rows;
    }
  }
  A.outerIndexPtr()[unknowns.total] = nonzeros;
  A.resizeNonZeros(nonzeros);

  std::vector<std::pair<long, int>> below;  // first unknown of each later neighbour, and its place in `near`
  for (const int v : unknowns.order) {
    double diagonal = 0;
    below.clear();
    for (int k = near.start[v]; k < near.start[v + 1]; ++k) {
      diagonal += w[near.edge[k]];
      if (later(v, near.neighbor[k])) below.emplace_back(unknowns.first[near.neighbor[k]], k);
    }
    std::sort(below.begin(), below.end());
    for (int c = 0; c < unknowns.count[v]; ++c) {
      long at = A.outerIndexPtr()[unknowns.first[v] + c];
      for (int r = c; r < unknowns.count[v]; ++r) {
        A.innerIndexPtr()[at] = unknowns.first[v] + r;
        A.valuePtr()[at++] = r == c ? diagonal : 0.0;
      }
      for (const auto& [row, k] : below) {
        const Block block = coupling(near.edge[k], v);
        for (int r = 0; r < unknowns.count[near.neighbor[k]]; ++r) {
          A.innerIndexPtr()[at] = row + r;
          A.valuePtr()[at++] = -w[near.edge[k]] * block(r, c);
        }
      }
    }
  }
  return A;
}

std::unique_ptr<SparseFactor> factorize_laplacian(const SparseMatrix& A, const Unknowns& unknowns,
                                                  Backend backend) {
  if (unknowns.total == 0) return nullptr;
  try {
    return factorize(A, backend);
  } catch (const NotPositiveDefinite& error) {
    const auto holder = std::upper_bound(unknowns.order.begin(), unknowns.order.end(), error.column,
                                         [&](long column, int v) { return column < unknowns.first[v]; });
    const std::string vertex = error.column < 0 ? "a vertex" : fmt::format("vertex {}", *(holder - 1));
    throw MeshError(fmt::format(
        "no positive weights tie {} to the cones; give it positive weights, or use --weights uniform",
        vertex));
  }
}

}  // namespace

struct LaplacianSolver::System {
  Unknowns unknowns;
  std::unique_ptr<SparseFactor> factor;
};

LaplacianSolver::LaplacianSolver(const CutMesh& cut, const GluedEdges& glued, const EdgeWeights& weights,
                                 const BoundaryConditions& boundary, const LaplacianOptions& options)
    : cut_(cut), boundary_(boundary), glued_(glued), w_(weights.w) {
  const int n = static_cast<int>(boundary.basis_of.size());
  const Neighbors near = neighbors(ends(glued), n);
  const std::vector<int> order = fill_reducing_order(near.start, near.neighbor);

  std::vector<int> inside(n, 1), room(n);
  for (int v = 0; v < n; ++v) {
    room[v] = static_cast<int>(boundary.basis(v).cols());
    if (room[v] == 0) inside[v] = 0;
  }
  for (const int v : cut.boundary) inside[cut.source_vertex[v]] = 0;

  disk_ = std::make_unique<System>();
  disk_->unknowns = number_unknowns(order, inside);
  disk_->factor = factorize_laplacian(
      assemble(disk_->unknowns, near, w_, [](int, int) { return Block(Block::Identity(1, 1)); }),
      disk_->unknowns, options.backend);

  // Edge (i, j, g) couples B_i' g B_j; seen from j, its transpose.
  const auto coupling = [&](int e, int v) -> Block {
    const auto [i, j, t] = glued.edges[e];
    const Matrix3& g = glued.transforms[t];
    return v == j ? Block(boundary.basis(i).transpose() * g * boundary.basis(j))
                  : Block(boundary.basis(j).transpose() * g.transpose() * boundary.basis(i));
  };
  coupled_ = std::make_unique<System>();
  coupled_->unknowns = number_unknowns(order, room);
  coupled_->factor = factorize_laplacian(assemble(coupled_->unknowns, near, w_, coupling), coupled_->unknowns,
                                         options.backend);
}

LaplacianSolver::~LaplacianSolver() = default;
LaplacianSolver::LaplacianSolver(LaplacianSolver&&) noexcept = default;

Eigen::MatrixXd LaplacianSolver::extend_harmonically(const Eigen::MatrixXd& boundary_positions) const {
  const Unknowns& unknowns = disk_->unknowns;
  Eigen::MatrixXd result = boundary_positions;
  if (unknowns.total == 0) return result;
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(unknowns.total, boundary_positions.cols());
  // An edge between an unknown and a given position pulls at the unknown; edges have two images only along
  // the cut, where both ends are given.
  std::vector<char> done(glued_.edges.size(), 0);
  for (int h = 0; h < static_cast<int>(cut_.F.size()); ++h) {
    const int a = origin(cut_.F, h), b = target(cut_.F, h), e = glued_.edge_of[h];
    const long ua = unknowns.first[cut_.source_vertex[a]], ub = unknowns.first[cut_.source_vertex[b]];
    if (done[e] || (ua < 0) == (ub < 0)) continue;
    done[e] = 1;
    if (ua >= 0) {
      rhs.row(ua) += w_[e] * boundary_positions.row(b);
    } else {
      rhs.row(ub) += w_[e] * boundary_positions.row(a);
    }
  }
  const Eigen::MatrixXd x = disk_->factor->solve(rhs);
  for (const int v : unknowns.order) result.row(v) = x.row(unknowns.first[v]);
  return result;
}

Points LaplacianSolver::precondition(const Points& gradient) const {
  const Unknowns& unknowns = coupled_->unknowns;
  Points result = Points::Zero(gradient.rows(), 3);
  if (unknowns.total == 0) return result;
  Eigen::VectorXd rhs(unknowns.total);
  for (const int v : unknowns.order)
    rhs.segment(unknowns.first[v], unknowns.count[v]) =
        0.5 * boundary_.basis(v).transpose() * gradient.row(v).transpose();
  const Eigen::VectorXd x = coupled_->factor->solve(rhs);
  for (const int v : unknowns.order)
    result.row(v) = boundary_.basis(v) * x.segment(unknowns.first[v], unknowns.count[v]);
  return result;
}

}  // namespace orbitutte
