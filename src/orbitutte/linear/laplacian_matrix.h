// SPDX-License-Identifier: MIT
// Laplacians of graphs as sparse matrices, in blocks of one to three unknowns per vertex. Private to linear/,
// solve/ and cones/.
#pragma once

#include <algorithm>
#include <memory>
#include <vector>

#include "orbitutte/linear/sparse_factor.h"
#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

using Block = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, 3, 3>;

/// Solutions are in single precision. Along edges with larger weights than this, their errors would be forces
/// of the size of those that they are to remove.
constexpr double stiff_weight = 1e6;

// The unknowns of all vertices, numbered in the order of elimination.
struct Unknowns {
  /// The vertices that have unknowns.
  std::vector<int> order;
  /// The first unknown of each vertex; -1 if it has none.
  std::vector<long> first;
  /// The number of unknowns of each vertex: 0 to 3.
  std::vector<int> count;
  long total = 0;
};

/// Numbers the unknowns of the vertices in `order`; `count` says how many each vertex has.
Unknowns number_unknowns(const std::vector<int>& order, std::vector<int> count);

/// The vertex to which an unknown belongs.
int holder(const Unknowns& unknowns, long unknown);

/// The error for a Laplacian that is not positive definite at this vertex (-1: the vertex is not known).
MeshError not_tied(int vertex);

/// Calls factorize() and turns its failure into a MeshError that names the vertex. Null if there are no
/// unknowns.
std::unique_ptr<SparseFactor> factorize_laplacian(const SparseMatrix& A, const Unknowns& unknowns,
                                                  Backend backend);

/// Calls eliminate() for all unknowns, with the same error. The factor is in single precision.
LeadingFactor eliminate_laplacian(const SparseMatrix& A, const Unknowns& unknowns, Backend backend);

// The lower triangle of the Laplacian of sum of w |x_i - g x_j|^2 over the edges, in blocks. `coupling(e, v)`
// is the block of edge e in the rows of its other end and the columns of v, without the factor -w.
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

  // The first unknown of each later neighbour, and its place in `near`.
  std::vector<std::pair<long, int>> below;
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

}  // namespace orbitutte
