// SPDX-License-Identifier: MIT
#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "orbitutte/geometry/stereographic_chart.h"
#include "orbitutte/linear/dense_factor.h"
#include "orbitutte/linear/laplacian_matrix.h"
#include "orbitutte/linear/substructure.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/laplacian_systems.h"

namespace orbitutte {
namespace {

// The unknowns of the disk's graph, one for each vertex inside in the order of the dissection, then one for
// each node of a bank.
struct DiskUnknowns {
  std::vector<int> node;                 // of every unknown
  std::vector<int> of;                   // of every node: its unknown, or -1 where it is held
  std::vector<EliminationBlock> blocks;  // of the inner ones
  int inner = 0;

  int count() const { return static_cast<int>(node.size()); }
  int banks() const { return count() - inner; }
  int bank(int k) const { return node[inner + k]; }
};

// The nodes of the dissection down to the depth at which subtrees are small, every such subtree in one block.
std::vector<EliminationBlock> elimination_blocks(const Dissection& dissection,
                                                 const std::vector<long>& unknowns_before, int block_size) {
  int depth = 0, deepest = 0;
  for (const Dissection::Node& node : dissection.nodes) deepest = std::max(deepest, node.depth);
  while (depth < deepest && static_cast<int>(dissection.order.size()) >> depth > block_size) ++depth;
  std::vector<int> block_of(dissection.nodes.size(), -1);
  std::vector<EliminationBlock> blocks;
  for (std::size_t k = 0; k < dissection.nodes.size(); ++k) {
    const Dissection::Node& node = dissection.nodes[k];
    if (node.depth > depth) continue;
    block_of[k] = static_cast<int>(blocks.size());
    blocks.push_back(
        {-1, unknowns_before[node.depth == depth ? node.first : node.begin], unknowns_before[node.end]});
  }
  for (std::size_t k = 0; k < dissection.nodes.size(); ++k) {
    const int parent = dissection.nodes[k].parent;
    if (block_of[k] >= 0 && parent >= 0) blocks[block_of[k]].parent = block_of[parent];
  }
  return blocks;
}

DiskUnknowns disk_unknowns(const LaplacianProblem& problem, int block_size) {
  DiskUnknowns unknowns;
  std::vector<long> before = {0};  // of the k first vertices of the order, how many are inside
  for (const int v : problem.dissection.order) {
    if (problem.graph.inside[v]) unknowns.node.push_back(v);
    before.push_back(static_cast<long>(unknowns.node.size()));
  }
  unknowns.inner = unknowns.count();
  unknowns.blocks = elimination_blocks(problem.dissection, before, block_size);
  unknowns.node.insert(unknowns.node.end(), problem.graph.banks.begin(), problem.graph.banks.end());
  unknowns.of.assign(problem.graph.node_count(), -1);
  for (int k = 0; k < unknowns.count(); ++k) unknowns.of[unknowns.node[k]] = k;
  return unknowns;
}

// Sorts the entries of every column by their rows, as Eigen and CHOLMOD expect them.
void sort_columns(SparseMatrix& K) {
  parallel_ranges(static_cast<int>(K.cols()), [&](int begin, int end) {
    std::vector<std::pair<long, double>> column;
    for (int k = begin; k < end; ++k) {
      const long first = K.outerIndexPtr()[k], last = K.outerIndexPtr()[k + 1];
      column.clear();
      for (long at = first; at < last; ++at) column.emplace_back(K.innerIndexPtr()[at], K.valuePtr()[at]);
      std::sort(column.begin(), column.end());
      for (long at = first; at < last; ++at) {
        K.innerIndexPtr()[at] = column[at - first].first;
        K.valuePtr()[at] = column[at - first].second;
      }
    }
  });
}

// The lower triangle of the Laplacian of the disk's graph. An edge along the cut has two images; the whole
// weight goes to one, since gluing adds them up.
SparseMatrix disk_laplacian(const LaplacianProblem& problem, const DiskUnknowns& unknowns) {
  const int count = unknowns.count();
  std::vector<std::array<int, 2>> ends(problem.graph.edge_count());  // ascending; -1 where held
  parallel_ranges(static_cast<int>(ends.size()), [&](int begin, int end) {
    for (int e = begin; e < end; ++e) {
      const auto [a, b] = problem.graph.ends(e);
      const auto [lower, upper] = std::minmax(unknowns.of[a], unknowns.of[b]);
      ends[e] = {lower, upper};
    }
  });
  SparseMatrix K(count, count);
  long* start = K.outerIndexPtr();
  std::fill(start, start + count + 1, 1);
  start[0] = 0;
  parallel_parts(count, [&](int begin, int end) {
    for (const auto& [a, b] : ends)
      if (a >= begin && a < end) ++start[a + 1];
  });
  for (int k = 0; k < count; ++k) start[k + 1] += start[k];
  K.resizeNonZeros(start[count]);
  parallel_parts(count, [&](int begin, int end) {
    std::vector<long> fill(start + begin, start + end);
    const auto diagonal = [&](int k) -> double& { return K.valuePtr()[start[k]]; };
    for (int k = begin; k < end; ++k) {
      K.innerIndexPtr()[fill[k - begin]++] = k;
      diagonal(k) = 0;
    }
    for (std::size_t e = 0; e < ends.size(); ++e) {
      const auto [a, b] = ends[e];
      const double w = problem.w[static_cast<Eigen::Index>(e)];
      if (a >= begin && a < end) {
        const long at = fill[a - begin]++;
        K.innerIndexPtr()[at] = b;
        K.valuePtr()[at] = -w;
        diagonal(a) += w;
      }
      if (b >= begin && b < end) diagonal(b) += w;
    }
  });
  sort_columns(K);
  return K;
}

class BankedSystems : public LaplacianSystems {
 public:
  BankedSystems(const LaplacianProblem& problem, const LaplacianOptions& options, LaplacianReuse& reuse)
      : graph_(problem.graph),
        boundary_(problem.boundary),
        disk_(disk_unknowns(problem, options.block_size)) {
    SparseMatrix K = disk_laplacian(problem, disk_);
    const bool is_stiff = problem.w.size() > 0 && problem.w.maxCoeff() > stiff_weight;
    try {
      factorize(K, {options.backend, is_stiff ? Precision::full : Precision::single}, reuse);
    } catch (const MeshError&) {
      if (is_stiff) throw;
      factorize(K, {options.backend, Precision::full}, reuse);
    }
    if (reuse.kept == Kept::factors) reuse.disk_laplacian.swap(K);
  }

  Points solve_disk(const Points& f) const override {
    SinglePoints y = of_inner_nodes(f);
    for (const int k : open_banks_) y.row(disk_.inner + k) = f.row(disk_.bank(k)).cast<float>();
    factor_->forward(y);
    settle_open_banks(y);
    factor_->backward(y);
    return of_all_nodes(y, f.rows());
  }

  bool knows_banks() const override { return true; }

  Points settle(const Points& f, const Points& positions, const StereographicChart& chart) const override {
    SinglePoints y = of_inner_nodes(f);
    if ((y.array() != 0).any()) factor_->forward(y);  // not where held vertices see banks alone
    for (int k = 0; k < disk_.banks(); ++k) y.row(disk_.inner + k) += f.row(disk_.bank(k)).cast<float>();
    const SinglePoints pull = y.bottomRows(disk_.banks());
    Points place = placed_banks(positions, pull, chart);
    settle_banks(place, pull, chart);
    y.bottomRows(disk_.banks()) = pictures(place, chart).cast<float>();
    factor_->backward(y);
    return of_all_nodes(y, positions.rows());
  }

  // Eliminating the inner vertices leaves f_B - K_BI K_II^-1 f_I on the banks, before they are glued; and
  // once their positions x_B are known, those of the inner vertices follow.
  Points solve_glued(const Points& f) const override {
    SinglePoints y = of_inner_nodes(f);
    factor_->forward(y);
    if (glued_.total > 0) solve_banks(on_glued(f), y.bottomRows(disk_.banks()));
    factor_->backward(y);
    return of_all_nodes(y, f.rows());
  }

 private:
  // The rows of the inner nodes in the order of the unknowns, and zero on the banks.
  SinglePoints of_inner_nodes(const Points& f) const {
    SinglePoints y(disk_.count(), 3);
    parallel_ranges(disk_.inner, [&](int begin, int end) {
      for (int k = begin; k < end; ++k) y.row(k) = f.row(disk_.node[k]).cast<float>();
    });
    y.bottomRows(disk_.banks()).setZero();
    return y;
  }

  // The unknowns, each at its node, those of the first `count` nodes; zero where held.
  Points of_all_nodes(const SinglePoints& y, Eigen::Index count) const {
    Points result(count, 3);
    parallel_ranges(static_cast<int>(count), [&](int begin, int end) {
      for (int node = begin; node < end; ++node) {
        if (const int k = disk_.of[node]; k >= 0)
          result.row(node) = y.row(k).cast<double>();
        else
          result.row(node).setZero();
      }
    });
    return result;
  }

  // Factorises the disk, its banks glued, and the start's system. Single precision does not suffice where few
  // or light edges tie something: then MeshError is thrown as if nothing tied it.
  void factorize(const SparseMatrix& K, SubstructureOptions how, LaplacianReuse& reuse) {
    const bool is_same = reuse.disk_factor && reuse.disk_factor->border() == disk_.banks() &&
                         reuse.disk_factor->precision() == how.precision && equal(K, reuse.disk_laplacian);
    std::shared_ptr<Substructure> made;
    if (!is_same) {
      how.earlier = reuse.disk_factor.get();
      how.serves_later = reuse.kept == Kept::factors;
      made = factorized(K, how);
    }
    factor_ = is_same ? reuse.disk_factor : made;
    how.precision == Precision::single ? factorize_banks<float>() : factorize_banks<double>();
    if (made && !how.serves_later) made->release_schur_complement();
    if (made && how.serves_later) reuse.disk_factor = made;
  }

  std::shared_ptr<Substructure> factorized(const SparseMatrix& K, const SubstructureOptions& how) const {
    try {
      return std::make_shared<Substructure>(K, disk_.blocks, how);
    } catch (const NotPositiveDefinite& error) {
      throw not_tied(error.column < 0 ? -1 : graph_.vertex[disk_.node[error.column]]);
    }
  }

  template <typename Real>
  void factorize_banks() {
    const DenseMatrix<Real>& S = factor_->schur_complement<Real>();
    glue_banks(S);
    factorize_start(S);
  }
  int source(int bank) const { return graph_.vertex[disk_.bank(bank)]; }

  // The 3 x k matrix that takes the unknowns of a bank node's vertex to its position.
  Block placement(int bank) const {
    return graph_.transform(disk_.bank(bank)).matrix() * boundary_.basis(source(bank));
  }

  Eigen::Matrix<float, 3, Eigen::Dynamic, Eigen::ColMajor, 3, 3> single_placement(int bank) const {
    return placement(bank).cast<float>();
  }

  // Numbers the unknowns of the vertices on the banks; the bank nodes that are images of each.
  std::vector<std::vector<int>> number_glued() {
    std::vector<int> count(boundary_.basis_of.size(), 0), order, place(count.size());
    std::vector<std::vector<int>> copies;
    for (int k = 0; k < disk_.banks(); ++k) {
      const int v = source(k);
      if (count[v] == 0) {
        place[v] = static_cast<int>(order.size());
        order.push_back(v);
        copies.emplace_back();
      }
      copies[place[v]].push_back(k);
      count[v] = static_cast<int>(boundary_.basis(v).cols());
    }
    glued_ = number_unknowns(order, std::move(count));
    return copies;
  }

  // Factorises N'(S x I3)N: in single precision, or where that spoils it in S's.
  template <typename Real>
  void glue_banks(const DenseMatrix<Real>& S) {
    const std::vector<std::vector<int>> copies = number_glued();
    try {
      glued_factor_ = glued_matrix<float>(copies, S);
      cholesky(glued_factor_);
    } catch (const NotPositiveDefinite&) {
      try {
        if constexpr (std::is_same_v<Real, float>) throw;
        Eigen::MatrixXd glued = glued_matrix<double>(copies, S);
        cholesky(glued);
        glued_factor_ = glued.cast<float>();
      } catch (const NotPositiveDefinite& error) {
        throw not_tied(holder(glued_, error.column));
      }
    }
  }

  // N'(S x I3)N, where N takes the glued unknowns to the positions of all bank nodes: 3 x k placements, few
  // of which differ. Its lower triangle.
  template <typename Real, typename Stored>
  DenseMatrix<Real> glued_matrix(const std::vector<std::vector<int>>& copies,
                                 const DenseMatrix<Stored>& S) const {
    const int banks = disk_.banks();
    std::vector<Block> distinct;
    std::vector<int> kind(banks);
    std::vector<long> row(banks);
    for (int k = 0; k < banks; ++k) {
      const Block here = placement(k);
      const auto same = std::find_if(distinct.begin(), distinct.end(),
                                     [&](const Block& b) { return b.cols() == here.cols() && b == here; });
      kind[k] = static_cast<int>(same - distinct.begin());
      if (same == distinct.end()) distinct.push_back(here);
      row[k] = glued_.first[source(k)];
    }
    const auto kinds = static_cast<int>(distinct.size());
    std::vector<Block> products;  // of the transpose of one with the other
    for (const Block& left : distinct)
      for (const Block& right : distinct) products.emplace_back(left.transpose() * right);

    DenseMatrix<Real> glued(glued_.total, glued_.total);
    parallel_for(static_cast<int>(copies.size()), [&](int at) {
      const int vertex = glued_.order[at];
      const long first = glued_.first[vertex];
      Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(glued_.total, glued_.count[vertex]);
      for (const int k : copies[at]) {
        for (int l = 0; l < banks; ++l) {
          if (row[l] < first) continue;
          const Block& product = products[kind[l] * kinds + kind[k]];
          const double s = S(std::max(l, k), std::min(l, k));
          for (int c = 0; c < product.cols(); ++c)
            for (int r = 0; r < product.rows(); ++r) columns(row[l] + r, c) += s * product(r, c);
        }
      }
      glued.middleCols(first, columns.cols()) = columns.cast<Real>();
    });
    return glued;
  }

  // The start does not know where those bank nodes are that the cut's boundary does not name. Few are: their
  // part of S is factorised once more, without gluing.
  template <typename Real>
  void factorize_start(const DenseMatrix<Real>& S) {
    response_ = S.template cast<float>();
    response_.triangularView<Eigen::StrictlyUpper>() = response_.transpose();
    open_banks_.clear();
    for (int k = 0; k < disk_.banks(); ++k)
      if (graph_.unknown_at_start(disk_.bank(k)) && S(k, k) != 0) open_banks_.push_back(k);
    if (open_banks_.empty()) return;
    Eigen::MatrixXd open = S(open_banks_, open_banks_).template cast<double>();
    open.diagonal() *= 1 + weak_tie;
    start_factor_.compute(open);
    if (start_factor_.info() != Eigen::Success) throw not_tied(source(open_banks_.front()));
  }

  // Replaces the right-hand sides of the bank nodes in y by their positions in the start: zero where given.
  void settle_open_banks(SinglePoints& y) const {
    Points open(static_cast<Eigen::Index>(open_banks_.size()), 3);
    for (Eigen::Index k = 0; k < open.rows(); ++k)
      open.row(k) = y.row(disk_.inner + open_banks_[k]).cast<double>();
    if (open.rows() > 0) open = start_factor_.solve(open);
    y.bottomRows(disk_.banks()).setZero();
    for (Eigen::Index k = 0; k < open.rows(); ++k)
      y.row(disk_.inner + open_banks_[k]) = open.row(k).cast<float>();
  }

  // Where the bank nodes (rows) are if their vertices have these positions. Of those that the cut's boundary
  // does not name, the one in place is where the others and `pull` want it.
  Points placed_banks(Points positions, const SinglePoints& pull, const StereographicChart& chart) const {
    Points place(disk_.banks(), 3);
    const auto put = [&](int k) {
      place.row(k) = graph_.transform(disk_.bank(k)) * positions.row(source(k)).transpose();
    };
    for (int k = 0; k < disk_.banks(); ++k) put(k);
    if (open_banks_.empty()) return place;
    Points flat = pictures(place, chart);
    for (const int k : open_banks_) flat.row(k).setZero();
    const Points rest = (pull - response_to(flat.cast<float>())).cast<double>();
    const Points open = start_factor_.solve(Points(rest(open_banks_, Eigen::all)));
    for (std::size_t k = 0; k < open_banks_.size(); ++k)
      if (const int b = open_banks_[k]; disk_.bank(b) == source(b))
        positions.row(source(b)) = chart.point(open.row(static_cast<Eigen::Index>(k)));
    for (const int k : open_banks_) put(k);
    return place;
  }

  // Moves the bank nodes, as long as steps shrink, to where the flow from both sides of a seam balances.
  void settle_banks(Points& place, const SinglePoints& pull, const StereographicChart& chart) const {
    constexpr int most_steps = 5;
    constexpr double small_step = 1e-3;  // of the error that it leaves, the inside has as much
    double last = std::numeric_limits<double>::infinity();
    Points before = place;
    for (int k = 0; k < most_steps && last > small_step; ++k) {
      const Points step = balancing_step(place, pull, chart);
      const double longest = step.rows() > 0 ? step.rowwise().norm().maxCoeff() : 0;
      if (!(longest < last)) place = before;
      if (!(longest < 0.5 * last)) return;
      before = place;
      move_points(boundary_.space, place, step, 1, place);
      last = longest;
    }
  }

  // The flow f_B - K_BI K_II^-1 f_I - S z at the banks, z their pictures, is conformally invariant: carried
  // to the space, it is half of the energy's gradient where the map is conformal inside. The glued matrix
  // makes steps of it, as the preconditioner does for the whole mesh.
  Points balancing_step(const Points& place, const SinglePoints& pull,
                        const StereographicChart& chart) const {
    const Points flat = pictures(place, chart);
    SinglePoints flow = pull - response_to(flat.cast<float>());
    for (Eigen::Index k = 0; k < flow.rows(); ++k)
      flow.row(k) = boundary_.space.metric()
                        .cwiseProduct(chart.tangent(flat.row(k), flow.row(k).cast<double>()))
                        .transpose()
                        .cast<float>();
    solve_banks(Eigen::VectorXf::Zero(glued_.total), flow);
    return flow.cast<double>();
  }

  static Points pictures(const Points& place, const StereographicChart& chart) {
    Points flat(place.rows(), 3);
    for (Eigen::Index k = 0; k < flat.rows(); ++k) flat.row(k) = chart.flat(place.row(k));
    return flat;
  }

  // S z.
  SinglePoints response_to(const SinglePoints& z) const {
    constexpr Eigen::Index length = 128;
    SinglePoints result(z.rows(), 3);
    parallel_for(static_cast<int>((z.rows() + length - 1) / length), [&](int part) {
      const Eigen::Index begin = part * length, count = std::min(length, z.rows() - begin);
      result.middleRows(begin, count).noalias() = response_.middleCols(begin, count).transpose() * z;
    });
    return result;
  }

  // Right-hand sides of the vertices on the banks.
  Eigen::VectorXf on_glued(const Points& f) const {
    Eigen::VectorXf x(glued_.total);
    for (const int v : glued_.order)
      x.segment(glued_.first[v], glued_.count[v]) =
          (boundary_.basis(v).transpose() * f.row(v).transpose()).cast<float>();
    return x;
  }

  // Replaces the right-hand sides at the bank nodes (rows), before gluing, by their positions; x holds those
  // of their vertices.
  void solve_banks(Eigen::VectorXf x, Eigen::Ref<SinglePoints> banks) const {
    for (int k = 0; k < disk_.banks(); ++k)
      x.segment(glued_.first[source(k)], glued_.count[source(k)]) +=
          single_placement(k).transpose() * banks.row(k).transpose();
    glued_factor_.triangularView<Eigen::Lower>().solveInPlace(x);
    glued_factor_.transpose().triangularView<Eigen::Upper>().solveInPlace(x);
    for (int k = 0; k < disk_.banks(); ++k)
      banks.row(k) =
          (single_placement(k) * x.segment(glued_.first[source(k)], glued_.count[source(k)])).transpose();
  }

  const DiskGraph& graph_;
  const BoundaryConditions& boundary_;
  DiskUnknowns disk_;
  std::shared_ptr<const Substructure> factor_;
  Unknowns glued_;                            // of the vertices on the banks
  Eigen::MatrixXf response_;                  // S in single precision, for the start
  Eigen::MatrixXf glued_factor_;              // the Cholesky factor of N'(S x I3)N
  std::vector<int> open_banks_;               // bank nodes that are unknown at the start
  Eigen::LLT<Eigen::MatrixXd> start_factor_;  // of their part of S
};

}  // namespace

std::unique_ptr<LaplacianSystems> banked_systems(const LaplacianProblem& problem,
                                                 const LaplacianOptions& options, LaplacianReuse& reuse) {
  return std::make_unique<BankedSystems>(problem, options, reuse);
}

}  // namespace orbitutte
