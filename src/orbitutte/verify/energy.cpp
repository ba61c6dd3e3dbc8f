// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/verify/edge_images.h"
#include "orbitutte/verify/laid_out.h"

namespace orbitutte {
namespace {

// Of faces whose corners have positions of their own; an edge is as long in one of its faces as in the other.
double energy_of_layout(const Embedding& layout, const std::vector<int>& edge_of, const Eigen::VectorXd& w) {
  std::vector<char> done(w.size(), 0);
  double energy = 0;
  for (int h = 0; h < static_cast<int>(edge_of.size()); ++h) {
    if (std::exchange(done[edge_of[h]], 1)) continue;
    const double d = layout.space().distance(layout.positions.row(h), layout.positions.row(next_halfedge(h)));
    energy += w[edge_of[h]] * d * d;
  }
  return energy;
}

// With an image of every edge of the surface.
double energy_of_edges(const Connectivity& connectivity, const Embedding& embedding,
                       const Eigen::VectorXd& w) {
  double energy = 0;
  visit_edges(connectivity, embedding, [&](int e, int a, int b) {
    const double d = embedding.space().distance(embedding.positions.row(a), embedding.positions.row(b));
    energy += w[e] * d * d;
  });
  return energy;
}

}  // namespace

double dirichlet_energy(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding) {
  if (!weights.triangulation) return energy_of_edges(surface.connectivity, embedding, weights.w);
  const std::vector<int>& edge_of = weights.triangulation->connectivity.edge_of;
  return energy_of_layout(laid_out(surface, embedding, *weights.triangulation), edge_of, weights.w);
}

}  // namespace orbitutte
