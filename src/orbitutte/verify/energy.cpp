// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include "orbitutte/mesh/cone_weights.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/verify/edge_images.h"
#include "orbitutte/verify/laid_out.h"
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

EdgeWeights weights_of(const Mesh& mesh, const Connectivity& connectivity, const WeightOptions& options,
                       const Embedding& embedding) {
  std::vector<Mark> marks;
  for (const ConeCopies& cone : embedding.cones) marks.push_back({cone.order, cone.kind});
  const std::vector<double> angles = metric_angles(marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) cones.push_back({embedding.cones[k].vertex, angles[k]});
  return sharpened_at_cones(edge_weights(mesh, connectivity, options), cones);
}

double dirichlet_energy(const Mesh& mesh, const Connectivity& connectivity, const EdgeWeights& weights,
                        const Embedding& embedding) {
  if (!weights.triangulation) return dirichlet_energy(connectivity, weights, embedding);
  return dirichlet_energy(weights.triangulation->connectivity, weights,
                          laid_out(mesh, embedding, *weights.triangulation));
}

}  // namespace orbitutte
