// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include "orbitutte/verify/spherical_triangle.h"

namespace orbitutte {
namespace {

// The edge of the uncut mesh of every half-edge of the cut one; edges as `connect` numbers those of the
// input.
std::vector<int> source_edges(const Embedding& embedding) {
  Faces F = embedding.faces;
  for (int& v : F.reshaped()) v = embedding.source_vertex[v];
  return connect(F, F.maxCoeff() + 1).edge_of;
}

}  // namespace

double dirichlet_energy(const Connectivity& connectivity, const EdgeWeights& weights,
                        const Embedding& embedding) {
  const Faces& F = embedding.faces;
  const std::vector<int> edge_of = source_edges(embedding);
  std::vector<char> done(connectivity.edges.size(), 0);
  double energy = 0;
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    const int e = edge_of[h];
    if (done[e]) continue;
    done[e] = 1;
    const double d = arc_length(embedding.positions.row(origin(F, h)), embedding.positions.row(target(F, h)));
    energy += weights.w[e] * d * d;
  }
  return energy;
}

}  // namespace orbitutte
