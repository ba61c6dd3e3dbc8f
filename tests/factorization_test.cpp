// SPDX-License-Identifier: MIT
// Orders and factorisations below the Laplacian solver: dissection, sparse and dense factors, substructures.
#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include "orbitutte/linear/dense_factor.h"
#include "orbitutte/linear/dissection.h"
#include "orbitutte/linear/sparse_factor.h"
#include "orbitutte/linear/substructure.h"
#include "test_meshes.h"

namespace orbitutte::factorization_test {
namespace {

Neighbors neighbors_of(const Mesh& mesh) {
  const int n = test::vertex_count(mesh);
  return vertex_neighbors(connectivity_of(mesh.F, n).edges, n);
}

SparseMatrix lower_part(const Eigen::MatrixXd& A) {
  return Eigen::MatrixXd(A.triangularView<Eigen::Lower>()).sparseView();
}

Eigen::MatrixXd random_definite(int n, double density) {
  const Eigen::MatrixXd root = Eigen::MatrixXd::Random(n, n).cwiseProduct(
      (Eigen::MatrixXd::Random(n, n).array() > 1 - 2 * density).cast<double>().matrix());
  return root * root.transpose() + Eigen::MatrixXd::Identity(n, n);
}

// The Schur complement of A onto its last rows.
Eigen::MatrixXd schur_complement(const Eigen::MatrixXd& A, int last) {
  const Eigen::Index first = A.rows() - last;
  return A.bottomRightCorner(last, last) - A.bottomLeftCorner(last, first) *
                                               A.topLeftCorner(first, first).inverse() *
                                               A.topRightCorner(first, last);
}

double lower_difference(const Eigen::MatrixXd& A, const Eigen::MatrixXd& B) {
  if (A.size() == 0 && B.size() == 0) return 0;
  return Eigen::MatrixXd((A - B).triangularView<Eigen::Lower>()).cwiseAbs().maxCoeff();
}

// --- dissection

/// A double pyramid: two vertices with an edge to each of the others, in whose cluster most of them are.
Mesh hub(int corners) {
  Mesh mesh;
  mesh.V.resize(corners + 2, 3);
  mesh.F.resize(2 * corners, 3);
  mesh.V.topRows(2) << 0, 0, 1, 0, 0, -1;
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * std::numbers::pi * k / corners;
    const int a = 2 + k, b = 2 + (k + 1) % corners;
    mesh.V.row(a) << std::cos(angle), std::sin(angle), 0;
    mesh.F.row(2 * k) << 0, a, b;
    mesh.F.row(2 * k + 1) << 1, b, a;
  }
  return mesh;
}

// The tests' processes start without making the meshes: most run another test.
using MeshMaker = Mesh (*)();

class Dissected : public testing::TestWithParam<MeshMaker> {};
INSTANTIATE_TEST_SUITE_P(Meshes, Dissected,
                         testing::Values([] { return test::tetrahedron(); },
                                         [] { return test::icosphere(3); }, [] { return test::icosphere(5); },
                                         [] { return test::grid_disk(90, 90); },
                                         [] { return test::grid_disk(4000, 1); },
                                         [] { return test::united(test::icosphere(4), test::torus(80, 40)); },
                                         [] { return hub(1700); }, [] { return hub(20000); },
                                         [] { return test::united(hub(3000), hub(5000)); }));

TEST_P(Dissected, NothingIsPrinted) {
  testing::internal::CaptureStdout();
  dissect(neighbors_of(GetParam()()));
  EXPECT_EQ(testing::internal::GetCapturedStdout(), "");
}

TEST_P(Dissected, OrderNamesEveryVertexOnce) {
  std::vector<int> order = dissect(neighbors_of(GetParam()())).order;
  std::sort(order.begin(), order.end());
  std::vector<int> all(order.size());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(order, all);
}

TEST_P(Dissected, NodesTileTheOrderAndComeBeforeTheirParents) {
  const Dissection dissection = dissect(neighbors_of(GetParam()()));
  int at = 0;
  for (std::size_t k = 0; k < dissection.nodes.size(); ++k) {
    const Dissection::Node& node = dissection.nodes[k];
    EXPECT_EQ(node.begin, at);
    EXPECT_LE(node.first, node.begin);
    at = node.end;
    if (node.parent < 0) {
      EXPECT_EQ(k + 1, dissection.nodes.size());
      continue;
    }
    const Dissection::Node& parent = dissection.nodes[node.parent];
    EXPECT_GT(node.parent, static_cast<int>(k));
    EXPECT_EQ(parent.depth + 1, node.depth);
    EXPECT_LE(parent.first, node.first);
  }
  EXPECT_EQ(at, static_cast<int>(dissection.order.size()));
}

void expect_that_sets_separate(const Dissection& dissection, const Neighbors& graph) {
  std::vector<int> node_of(dissection.order.size());
  for (std::size_t k = 0; k < dissection.nodes.size(); ++k)
    for (int i = dissection.nodes[k].begin; i < dissection.nodes[k].end; ++i)
      node_of[dissection.order[i]] = static_cast<int>(k);
  const auto is_above = [&](int above, int node) {
    while (node >= 0 && node != above) node = dissection.nodes[node].parent;
    return node == above;
  };
  for (int v = 0; v < static_cast<int>(node_of.size()); ++v)
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k) {
      const int a = node_of[v], b = node_of[graph.neighbor[k]];
      ASSERT_TRUE(is_above(a, b) || is_above(b, a)) << v << ' ' << graph.neighbor[k];
    }
}

TEST_P(Dissected, EverySetSeparatesTheSubtreesBelowIt) {
  const Neighbors graph = neighbors_of(GetParam()());
  expect_that_sets_separate(dissect(graph), graph);
}

TEST_P(Dissected, SetsAdaptedToFurtherEdgesSeparateTheirSubtreesToo) {
  const Mesh mesh = GetParam()();
  const int n = test::vertex_count(mesh);
  std::vector<std::array<int, 2>> edges = connectivity_of(mesh.F, n).edges;
  const Dissection before = dissect(vertex_neighbors(edges, n));
  EXPECT_EQ(adapted(before, edges).order, before.order);
  for (int k = 0; k < 20; ++k) edges.push_back({k * 7 % n, (k + 1) * n / 22});
  std::erase_if(edges, [](const auto& edge) { return edge[0] == edge[1]; });
  const Dissection after = adapted(before, edges);
  expect_that_sets_separate(after, vertex_neighbors(edges, n));
  EXPECT_TRUE(std::is_permutation(after.order.begin(), after.order.end(), before.order.begin()));
}

TEST(Dissection, SeparatorsOfASphereAreShort) {
  const Dissection dissection =
      dissect(neighbors_of(test::icosphere(5)));  // 10242 vertices, 5 edges long, about
  const Dissection::Node& root = dissection.nodes.back();
  EXPECT_GT(dissection.nodes.size(), 7u);
  EXPECT_LT(root.end - root.begin, 3 * 101);
}

// --- dense factors

TEST(DenseFactor, PartialCholeskyLeavesTheFactorAndTheSchurComplement) {
  for (const auto& [n, own] : {std::pair(5, 0), std::pair(7, 7), std::pair(400, 250), std::pair(401, 401)}) {
    const Eigen::MatrixXd A = random_definite(n, 0.5);
    Eigen::MatrixXd L = A.leftCols(own), rest = A.bottomRightCorner(n - own, n - own);
    L.triangularView<Eigen::StrictlyUpper>().setZero();
    rest.triangularView<Eigen::StrictlyUpper>().setZero();
    partial_cholesky(Front<double>{own, n - own, L.data(), rest.data()});
    L.topRows(own).triangularView<Eigen::StrictlyUpper>().setZero();
    EXPECT_LT(lower_difference((L * L.transpose()).leftCols(own), A.leftCols(own)), 1e-12 * n);
    EXPECT_LT(lower_difference(rest, schur_complement(A, n - own)), 1e-9);
  }
}

TEST(DenseFactor, PartialCholeskyNamesTheColumnThatIsNotPositive) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(300, 300);
  A(250, 250) = -1;
  try {
    cholesky(A);
    FAIL();
  } catch (const NotPositiveDefinite& error) {
    EXPECT_EQ(error.column, 250);
  }
}

TEST(DenseFactor, MultiplyByTransposeIgnoresWhatLiesAboveTheDiagonal) {
  Eigen::MatrixXd L = Eigen::MatrixXd::Random(230, 230);
  const Eigen::MatrixXd lower = L.triangularView<Eigen::Lower>();
  multiply_by_transpose(L);
  EXPECT_LT(lower_difference(L, lower * lower.transpose()), 1e-12);
}

// --- sparse factors

TEST(SparseFactor, ForwardAndBackwardSolveAroundTheSchurComplement) {
  const int n = 90, trailing = 7;
  const Eigen::MatrixXd A = random_definite(n, 0.05), S = schur_complement(A, trailing);
  const SinglePoints b = SinglePoints::Random(n, 3);
  for (const Backend backend : available_backends()) {
    const auto elimination = eliminate<double>(lower_part(A), backend, trailing);
    EXPECT_LT(lower_difference(A.bottomRightCorner(trailing, trailing) + elimination.update, S), 1e-12)
        << name_of(backend);
    EXPECT_LT(lower_difference(eliminate<float>(lower_part(A), backend, trailing).update.cast<double>(),
                               elimination.update),
              1e-5)
        << name_of(backend);
    SinglePoints y = b;
    elimination.factor.forward(y);
    y.bottomRows(trailing) = S.cast<float>().inverse() * y.bottomRows(trailing);
    elimination.factor.backward(y);
    EXPECT_LT((A.cast<float>() * y - b).cwiseAbs().maxCoeff(), 1e-4) << name_of(backend);
  }
}

TEST(SparseFactor, BackendsAgreeAndSolve) {
  const Eigen::MatrixXd A = random_definite(200, 0.02), B = Eigen::MatrixXd::Random(200, 3);
  for (const Backend backend : available_backends())
    EXPECT_LT((A * factorize(lower_part(A), backend)->solve(B) - B).cwiseAbs().maxCoeff(), 1e-11)
        << name_of(backend);
}

TEST(SparseFactor, RefusesIndefiniteMatrices) {
  Eigen::MatrixXd A = Eigen::MatrixXd::Identity(2, 2);
  A(1, 1) = -1;
  for (const Backend backend : available_backends())
    EXPECT_THROW(factorize(lower_part(A), backend), NotPositiveDefinite);
}

// --- substructures

// A Laplacian plus the identity in the order of a dissection, with some more vertices, each beside two of the
// order, behind them.
struct Structure {
  SparseMatrix lower;
  Eigen::MatrixXd border;  // the Schur complement onto them, by another way
  std::vector<EliminationBlock> blocks;
  int inner, count;
};

Structure structure(const Mesh& mesh, int behind) {
  const Neighbors graph = neighbors_of(mesh);
  const Dissection dissection = dissect(graph);
  const int n = static_cast<int>(dissection.order.size());
  std::vector<int> place(n);
  for (int k = 0; k < n; ++k) place[dissection.order[k]] = k;
  std::vector<Eigen::Triplet<double, long>> entries;
  const auto couple = [&](int i, int j, double w) {
    entries.emplace_back(std::max(i, j), std::min(i, j), -w);
    entries.emplace_back(i, i, w);
    entries.emplace_back(j, j, w);
  };
  for (int v = 0; v < n; ++v)
    for (int k = graph.start[v]; k < graph.start[v + 1]; ++k)
      if (graph.neighbor[k] > v) couple(place[v], place[graph.neighbor[k]], 0.5 + 0.1 * (v % 7));
  for (int k = 0; k < behind; ++k) {
    couple(place[(13 * k) % n], n + k, 1.0 + k);
    couple(place[(101 * k + 5) % n], n + k, 0.25);
  }
  for (int k = 0; k < n + behind; ++k) entries.emplace_back(k, k, 0.01);
  Structure result = {SparseMatrix(n + behind, n + behind), {}, {}, n, n + behind};
  result.lower.setFromTriplets(entries.begin(), entries.end());
  for (const Dissection::Node& node : dissection.nodes)
    result.blocks.push_back({node.parent, node.begin, node.end});
  result.border = Eigen::MatrixXd(result.lower.bottomRightCorner(behind, behind)) +
                  eliminate<double>(result.lower, Backend::eigen, behind).update;
  return result;
}

template <typename Real>
void expect_solutions(const Structure& s, const SubstructureOptions& how, double tolerance) {
  const Substructure factor(s.lower, s.blocks, how);
  const DenseMatrix<Real>& lower = factor.schur_complement<Real>();
  EXPECT_LT(lower_difference(lower.template cast<double>(), s.border), tolerance) << name_of(how.backend);
  const Eigen::MatrixXf S = lower.template cast<float>().template selfadjointView<Eigen::Lower>();
  const SinglePoints b = SinglePoints::Random(s.count, 3);
  SinglePoints y = b;
  factor.forward(y);
  y.bottomRows(20) = S.inverse() * y.bottomRows(20);
  factor.backward(y);
  const Points x = y.cast<double>();
  EXPECT_LT((s.lower.selfadjointView<Eigen::Lower>() * x - b.cast<double>()).cwiseAbs().maxCoeff(), 1e-4)
      << name_of(how.backend);
}

TEST(Substructure, SolvesAlongTheWholeTree) {
  const Structure s = structure(test::icosphere(5), 20);
  for (const Backend backend : available_backends()) {
    expect_solutions<double>(s, {backend, Precision::full}, 1e-11);
    expect_solutions<float>(s, {backend, Precision::single}, 1e-4);
  }
}

TEST(Substructure, TakesBlocksOfAnEarlierOneOnlyWhereAllThatGoesIntoThemIsTheSame) {
  const Structure s = structure(test::icosphere(5), 12);
  SubstructureOptions how;
  how.serves_later = true;
  const Substructure first(s.lower, s.blocks, how);
  const auto lower = [](const Substructure& factor) {
    return Eigen::MatrixXf(factor.schur_complement<float>().triangularView<Eigen::Lower>());
  };
  const std::size_t last = s.blocks.size() - 1;
  // In the first block, in a separator that has blocks below it, and behind all blocks.
  for (const long at : {3L, s.blocks[last - 1].begin, s.blocks[last].end}) {
    SparseMatrix changed = s.lower;
    changed.coeffRef(at, at) += 0.5;
    how.earlier = nullptr;
    const Substructure fresh(changed, s.blocks, how);
    how.earlier = &first;
    const Substructure again(changed, s.blocks, how);
    EXPECT_EQ(lower(again), lower(fresh));
    EXPECT_NE(lower(again), lower(first));
    SinglePoints y = SinglePoints::Random(s.count, 3), z = y;
    fresh.forward(y);
    again.forward(z);
    EXPECT_EQ(y, z);
  }
}

TEST(Substructure, NamesTheUnknownThatNothingHolds) {
  Structure s = structure(test::icosphere(5), 0);
  const long loose = s.blocks[5].begin;
  for (long column = 0; column < s.count; ++column)
    for (SparseMatrix::InnerIterator entry(s.lower, column); entry; ++entry)
      if (entry.row() == loose || entry.col() == loose) entry.valueRef() = 0;
  for (const Backend backend : available_backends()) {
    try {
      const Substructure factor(s.lower, s.blocks, {backend});
      FAIL() << name_of(backend);
    } catch (const NotPositiveDefinite& error) {
      if (backend == Backend::cholmod) EXPECT_EQ(error.column, loose);
    }
  }
}

}  // namespace
}  // namespace orbitutte::factorization_test
