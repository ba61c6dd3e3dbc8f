// SPDX-License-Identifier: MIT
#include "orbitutte/solve/laplacian_matrix.h"

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

std::unique_ptr<SparseFactor> factorize_laplacian(const SparseMatrix& A, const Unknowns& unknowns,
                                                  Backend backend, long trailing) {
  if (unknowns.total == 0) return nullptr;
  try {
    return factorize(A, backend, trailing);
  } catch (const NotPositiveDefinite& error) {
    const auto holder = std::upper_bound(unknowns.order.begin(), unknowns.order.end(), error.column,
                                         [&](long column, int v) { return column < unknowns.first[v]; });
    const std::string vertex = error.column < 0 ? "a vertex" : fmt::format("vertex {}", *(holder - 1));
    throw MeshError(fmt::format(
        "no positive weights tie {} to the cones; give it positive weights, or use --weights uniform",
        vertex));
  }
}

}  // namespace orbitutte
