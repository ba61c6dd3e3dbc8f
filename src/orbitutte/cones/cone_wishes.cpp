// SPDX-License-Identifier: MIT
#include "orbitutte/cones/cone_wishes.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "orbitutte/cones/fitted_cones.h"
#include "orbitutte/orbifold/target_words.h"

namespace orbitutte {
namespace {

// By vertex: how many vertices of the boundary the walk along it meets before; -1 inside.
std::vector<int> places_on_boundary(const Surface& surface) {
  std::vector<int> next(surface.vertex_count(), -1), place(surface.vertex_count(), -1);
  int first = -1;
  for (int h = 0; h < static_cast<int>(surface.triangles.size()); ++h)
    if (surface.connectivity.opposite[h] < 0)
      next[first = halfedge_origin(surface.triangles, h)] = halfedge_target(surface.triangles, h);
  for (int v = first, met = 0; v >= 0 && place[v] < 0; v = next[v]) place[v] = met++;
  return place;
}

// Those inside first, and then those on the boundary as it meets them.
FittedCones in_order_of_boundary(const Surface& surface, const FittedCones& cones) {
  const std::vector<int> place = places_on_boundary(surface);
  std::vector<int> order(cones.vertices.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](int a, int b) { return place[cones.vertices[a]] < place[cones.vertices[b]]; });
  FittedCones result = cones;
  for (std::size_t k = 0; k < order.size(); ++k) {
    result.vertices[k] = cones.vertices[order[k]];
    result.fit.angles[k] = cones.fit.angles[order[k]];
  }
  return result;
}

void require_sphere_or_disk(const Surface& surface) {
  if (surface.topology == Topology::sphere || surface.topology == Topology::disk) return;
  throw MeshError(fmt::format("cones of any angles need a sphere or a disk; the mesh is a {}",
                              text_of(surface.topology)));
}

void require_angles(const FitOptions& options) {
  FitOptions unbounded = options;
  unbounded.greatest_angle.reset();
  const double greatest = options.greatest(), most = unbounded.greatest();
  if (!(greatest > options.least_angle && greatest <= most))
    throw ArgumentError(
        fmt::format("the greatest angle is {:.4g} of the flat one; take more than {:.4g} and at most {:.4g}",
                    greatest, options.least_angle, most));
}

}  // namespace

FittedCones find_cones(const Surface& surface, const ConeWishes& wishes, const WeightOptions& weights) {
  require_sphere_or_disk(surface);
  require_angles(wishes.fit);
  return find_cones(ScaleKernel(surface, edge_weights(surface, weights), available_backends().front()),
                    wishes);
}

FittedCones find_cones(const ScaleKernel& kernel, const ConeWishes& wishes) {
  require_angles(wishes.fit);
  ConeWishes wanted = wishes;
  if (wishes.are_orders) wanted.fit.area.reset();
  FittedCones found = are_placed(wishes)
                          ? place_cones(kernel, wanted)
                          : FittedCones{wishes.kept, fit_angles(kernel, wishes.kept, wanted.fit)};
  if (wishes.are_orders) found.fit = fit_orders(kernel, found.vertices);
  return in_order_of_boundary(kernel.surface(), found);
}

}  // namespace orbitutte
