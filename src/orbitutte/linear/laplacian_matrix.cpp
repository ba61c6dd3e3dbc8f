// SPDX-License-Identifier: MIT
#include "orbitutte/linear/laplacian_matrix.h"

#include <fmt/format.h>

namespace orbitutte {

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

int holder(const Unknowns& unknowns, long unknown) {
  return *(std::upper_bound(unknowns.order.begin(), unknowns.order.end(), unknown,
                            [&](long number, int v) { return number < unknowns.first[v]; }) -
           1);
}

MeshError not_tied(int vertex) {
  return MeshError(fmt::format(
      "no positive weights tie {} to the cones; give it positive weights, or use --weights uniform",
      vertex < 0 ? "a vertex" : fmt::format("vertex {}", vertex)));
}

std::unique_ptr<SparseFactor> factorize_laplacian(const SparseMatrix& A, const Unknowns& unknowns,
                                                  Backend backend) {
  if (unknowns.total == 0) return nullptr;
  try {
    return factorize(A, backend);
  } catch (const NotPositiveDefinite& error) {
    throw not_tied(error.column < 0 ? -1 : holder(unknowns, error.column));
  }
}

LeadingFactor eliminate_laplacian(const SparseMatrix& A, const Unknowns& unknowns, Backend backend) {
  try {
    return eliminate<double>(A, backend, 0).factor;
  } catch (const NotPositiveDefinite& error) {
    throw not_tied(error.column < 0 ? -1 : holder(unknowns, error.column));
  }
}

}  // namespace orbitutte
