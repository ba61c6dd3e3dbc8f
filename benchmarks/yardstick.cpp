// SPDX-License-Identifier: MIT
#include "yardstick.h"

#include <cholmod.h>

#include <Eigen/SparseCore>
#include <chrono>
#include <stdexcept>

#include "orbitutte/inspect/recognition.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte::benchmarks {
namespace {

using Matrix = Eigen::SparseMatrix<double, Eigen::ColMajor, int>;

// The lower triangle of sum of w_ij (x_i - x_j)^2 + 1e-8 sum of x_i^2.
Matrix laplacian(const Mesh& mesh) {
  const int n = static_cast<int>(mesh.V.rows());
  const Surface surface = make_surface(mesh);
  const Connectivity& connectivity = surface.connectivity;
  const EdgeWeights weights = edge_weights(surface, {WeightKind::cotan});
  std::vector<Eigen::Triplet<double, int>> entries;
  entries.reserve(connectivity.edges.size() + n);
  Eigen::VectorXd diagonal = Eigen::VectorXd::Constant(n, 1e-8);
  for (std::size_t e = 0; e < connectivity.edges.size(); ++e) {
    const auto [i, j] = connectivity.edges[e];
    const double w = weights.w[static_cast<Eigen::Index>(e)];
    entries.emplace_back(j, i, -w);
    diagonal[i] += w;
    diagonal[j] += w;
  }
  for (int v = 0; v < n; ++v) entries.emplace_back(v, v, diagonal[v]);
  Matrix result(n, n);
  result.setFromTriplets(entries.begin(), entries.end());
  return result;
}

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

// The matrix as CHOLMOD sees it.
cholmod_sparse view_of(Matrix& lower) {
  cholmod_sparse A = {};
  A.nrow = A.ncol = static_cast<std::size_t>(lower.rows());
  A.nzmax = static_cast<std::size_t>(lower.nonZeros());
  A.p = lower.outerIndexPtr();
  A.i = lower.innerIndexPtr();
  A.x = lower.valuePtr();
  A.stype = -1;
  A.itype = CHOLMOD_INT;
  A.xtype = CHOLMOD_REAL;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = A.packed = 1;
  return A;
}

Factorisation factorise(Matrix& lower, int ordering) {
  cholmod_common common;
  cholmod_start(&common);
  common.print = 0;
  common.nmethods = 1;
  common.method[0].ordering = ordering;
  common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse A = view_of(lower);
  Factorisation result;
  auto start = std::chrono::steady_clock::now();
  cholmod_factor* L = cholmod_analyze(&A, &common);
  result.analyze_seconds = seconds_since(start);
  start = std::chrono::steady_clock::now();
  if (L) cholmod_factorize(&A, L, &common);
  result.factorize_seconds = seconds_since(start);
  const int status = common.status;
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  if (status != CHOLMOD_OK) throw std::runtime_error("CHOLMOD could not factorise the Laplacian");
  return result;
}

}  // namespace

Yardstick measure_yardstick(const Mesh& mesh) {
  Matrix lower = laplacian(mesh);
  return {factorise(lower, CHOLMOD_METIS), factorise(lower, CHOLMOD_AMD)};
}

}  // namespace orbitutte::benchmarks
