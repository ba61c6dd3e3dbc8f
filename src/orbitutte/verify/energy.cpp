// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include "orbitutte/verify/edge_images.h"
#include "orbitutte/verify/spherical_triangle.h"

namespace orbitutte {

double dirichlet_energy(const Connectivity& connectivity, const EdgeWeights& weights,
                        const Embedding& embedding) {
  double energy = 0;
  visit_edges(connectivity, embedding, [&](int e, int a, int b) {
    const double d = arc_length(embedding.positions.row(a), embedding.positions.row(b));
    energy += weights.w[e] * d * d;
  });
  return energy;
}

}  // namespace orbitutte
