// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include "orbitutte/verify/spherical_triangle.h"

namespace orbitutte {

double dirichlet_energy(const Connectivity& connectivity, const EdgeWeights& weights,
                        const Embedding& embedding) {
  const Faces& F = embedding.faces;
  std::vector<char> done(connectivity.edges.size(), 0);
  double energy = 0;
  for (int h = 0; h < static_cast<int>(F.size()); ++h) {
    const int e = connectivity.edge_of[h];
    if (done[e]) continue;
    done[e] = 1;
    const double d = arc_length(embedding.positions.row(origin(F, h)), embedding.positions.row(target(F, h)));
    energy += weights.w[e] * d * d;
  }
  return energy;
}

}  // namespace orbitutte
