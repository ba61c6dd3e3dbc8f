// SPDX-License-Identifier: MIT
#include "orbitutte/solve/laplacian_matrix.h"
#include "orbitutte/solve/laplacian_systems.h"

namespace orbitutte {
namespace {

// The Laplacian's edges in the cut disk. A weight along the cut is shared by the edge's two images.
struct CutGraph {
  Neighbors near;
  Eigen::VectorXd w;
};

CutGraph cut_graph(const LaplacianProblem& problem) {
  const int n_cut = problem.cut.vertex_count();
  const Connectivity connectivity = connect(problem.cut.F, n_cut);
  std::vector<int> images(problem.glued.edges.size(), 0), source(connectivity.edges.size());
  for (std::size_t h = 0; h < connectivity.edge_of.size(); ++h)
    source[connectivity.edge_of[h]] = problem.glued.edge_of[h];
  for (const int e : source) ++images[e];
  CutGraph graph = {neighbors(connectivity.edges, n_cut), Eigen::VectorXd(source.size())};
  for (std::size_t k = 0; k < source.size(); ++k)
    graph.w[static_cast<Eigen::Index>(k)] = problem.w[source[k]] / images[source[k]];
  return graph;
}

// All entries of the lower triangle, zeros too.
SparseMatrix lower_triangle(const Eigen::MatrixXd& A) {
  SparseMatrix lower(A.rows(), A.cols());
  lower.reserve(A.rows() * (A.rows() + 1) / 2);
  for (Eigen::Index column = 0; column < A.cols(); ++column) {
    lower.startVec(column);
    for (Eigen::Index row = column; row < A.rows(); ++row) lower.insertBack(row, column) = A(row, column);
  }
  lower.finalize();
  return lower;
}

class BankedSystems : public LaplacianSystems {
 public:
  BankedSystems(const LaplacianProblem& problem, Backend backend)
      : cut_(problem.cut), boundary_(problem.boundary) {
    const int n_cut = cut_.vertex_count();
    std::vector<int> order;
    for (const int v : problem.order)
      if (problem.inside[v]) order.push_back(v);
    leading_ = static_cast<long>(order.size());
    for (const int v : cut_.boundary)
      if (boundary_.basis(cut_.source_vertex[v]).cols() > 0) banks_.push_back(v);
    order.insert(order.end(), banks_.begin(), banks_.end());
    std::vector<int> count(n_cut, 0);
    for (const int v : order) count[v] = 1;
    disk_ = number_unknowns(order, std::move(count));

    const CutGraph graph = cut_graph(problem);
    disk_factor_ = factorize_laplacian(
        assemble(disk_, graph.near, graph.w, [](int, int) { return Block(Block::Identity(1, 1)); }), disk_,
        backend, static_cast<long>(banks_.size()));
    glue_banks(backend);
  }

  Eigen::MatrixXd solve_disk(const Eigen::MatrixXd& f) const override {
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(f.rows(), f.cols());
    if (!disk_factor_) return result;
    Eigen::MatrixXd x = Eigen::MatrixXd::Zero(disk_.total, f.cols());
    for (long k = 0; k < leading_; ++k) x.row(k) = f.row(disk_.order[k]);
    x = disk_factor_->solve_lower(x);
    x.bottomRows(bank_count()).setZero();  // the banks are held at zero
    x = disk_factor_->solve_upper(x);
    for (long k = 0; k < leading_; ++k) result.row(disk_.order[k]) = x.row(k);
    return result;
  }

  // With K = L L', the banks' right-hand side is f_B - K_BI K_II^-1 f_I = L_BB y_B, y = L^-1 (f_I, 0), before
  // they are glued; and once their positions x_B are known, L' x = (y_I, L_BB' x_B) gives the others.
  Points solve_glued(const Points& f) const override {
    Points result = Points::Zero(f.rows(), 3);
    if (!disk_factor_) return result;
    Eigen::MatrixXd y = Eigen::MatrixXd::Zero(disk_.total, 3);
    for (long k = 0; k < leading_; ++k) y.row(k) = f.row(disk_.order[k]);
    y = disk_factor_->solve_lower(y);
    if (glued_factor_) {
      const Eigen::MatrixXd z =
          solve_banks(f, trailing_.triangularView<Eigen::Lower>() * y.bottomRows(bank_count()));
      y.bottomRows(bank_count()) = trailing_.triangularView<Eigen::Lower>().transpose() * z;
    }
    y = disk_factor_->solve_upper(y);
    for (const int v : disk_.order)
      if (v < f.rows()) result.row(v) = y.row(disk_.first[v]);
    return result;
  }

 private:
  Eigen::Index bank_count() const { return static_cast<Eigen::Index>(banks_.size()); }

  // The 3 x k matrix that takes the unknowns of a bank vertex' input vertex to its position.
  Block placement(int cut_vertex) const {
    return boundary_.transform(cut_vertex) * boundary_.basis(cut_.source_vertex[cut_vertex]);
  }

  // Factorises N'(S x I3)N, where N takes the glued unknowns to the positions of all bank vertices.
  void glue_banks(Backend backend) {
    std::vector<int> count(boundary_.basis_of.size(), 0), order;
    for (const int v : banks_) {
      const int source = cut_.source_vertex[v];
      if (count[source] == 0) order.push_back(source);
      count[source] = static_cast<int>(boundary_.basis(source).cols());
    }
    glued_ = number_unknowns(order, std::move(count));
    if (glued_.total == 0) return;
    trailing_ = disk_factor_->trailing_block();
    const Eigen::MatrixXd S = trailing_.triangularView<Eigen::Lower>() * trailing_.transpose();
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(glued_.total, glued_.total);
    std::vector<Block> placements;
    for (const int v : banks_) placements.push_back(placement(v));
    for (Eigen::Index l = 0; l < bank_count(); ++l) {
      const int u = cut_.source_vertex[banks_[l]];
      const Block left = placements[l].transpose();
      for (Eigen::Index k = 0; k < bank_count(); ++k) {
        const int v = cut_.source_vertex[banks_[k]];
        if (glued_.first[u] < glued_.first[v]) continue;
        A.block(glued_.first[u], glued_.first[v], left.rows(), glued_.count[v]) +=
            S(l, k) * left * placements[k];
      }
    }
    glued_factor_ = factorize_laplacian(lower_triangle(A), glued_, backend);
  }

  // Positions (b x 3) of all bank vertices for the right-hand sides `own` of their input vertices and `rest`
  // of the banks.
  Eigen::MatrixXd solve_banks(const Points& own, const Eigen::MatrixXd& rest) const {
    Eigen::VectorXd rhs(glued_.total);
    for (const int v : glued_.order)
      rhs.segment(glued_.first[v], glued_.count[v]) = boundary_.basis(v).transpose() * own.row(v).transpose();
    for (Eigen::Index k = 0; k < bank_count(); ++k) {
      const int v = cut_.source_vertex[banks_[k]];
      rhs.segment(glued_.first[v], glued_.count[v]) +=
          placement(banks_[k]).transpose() * rest.row(k).transpose();
    }
    const Eigen::VectorXd z = glued_factor_->solve(rhs);
    Eigen::MatrixXd positions(bank_count(), 3);
    for (Eigen::Index k = 0; k < bank_count(); ++k) {
      const int v = cut_.source_vertex[banks_[k]];
      positions.row(k) = (placement(banks_[k]) * z.segment(glued_.first[v], glued_.count[v])).transpose();
    }
    return positions;
  }

  const CutMesh& cut_;
  const BoundaryConditions& boundary_;
  std::vector<int> banks_;  // the cut vertices of the boundary that may move
  long leading_ = 0;        // how many unknowns are inside; the banks' follow
  Unknowns disk_, glued_;   // by cut vertex; by input vertex on the banks
  std::unique_ptr<SparseFactor> disk_factor_, glued_factor_;
  Eigen::MatrixXd trailing_;  // L_BB
};

}  // namespace

std::unique_ptr<LaplacianSystems> banked_systems(const LaplacianProblem& problem, Backend backend) {
  return std::make_unique<BankedSystems>(problem, backend);
}

}  // namespace orbitutte
