// SPDX-License-Identifier: MIT
#include "orbitutte/verify/energy.h"

#include "orbitutte/mesh/cone_weights.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/verify/laid_out.h"
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

EdgeWeights weights_of(const Mesh& mesh, const WeightOptions& options, const Embedding& embedding) {
  std::vector<Mark> marks;
  for (const ConeCopies& cone : embedding.cones) marks.push_back({cone.order, cone.kind});
  const std::vector<double> angles = metric_angles(marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) cones.push_back({embedding.cones[k].vertex, angles[k]});
  const Connectivity connectivity = connect(mesh.F, static_cast<int>(mesh.V.rows()));
  return sharpened_at_cones(edge_weights(mesh, connectivity, options), cones);
}

double dirichlet_energy(const Mesh& mesh, const WeightOptions& options, const Embedding& embedding) {
  const EdgeWeights weights = weights_of(mesh, options, embedding);
  if (weights.triangulation)
    return dirichlet_energy(weights.triangulation->connectivity, weights,
                            laid_out(mesh, embedding, *weights.triangulation));
  return dirichlet_energy(connect(mesh.F, static_cast<int>(mesh.V.rows())), weights, embedding);
}

}  // namespace orbitutte
