// SPDX-License-Identifier: MIT
#include "orbitutte/preparation.h"

#include <fmt/format.h>

#include <array>

#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/parallel.h"
#include "orbitutte/weights/cone_weights.h"

namespace orbitutte {
namespace {

// The edges that have the weights: the surface's, or those of a triangulation of it.
const std::vector<std::array<int, 2>>& weighted_edges(const EdgeWeights& weights, const Surface& surface) {
  return weights.triangulation ? weights.triangulation->connectivity.edges : surface.connectivity.edges;
}

std::vector<ConeAngle> cone_angles(const Target& orbifold, const std::vector<int>& marked_vertices) {
  const std::vector<double> angles = metric_angles(orbifold.marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) cones.push_back({marked_vertices[k], angles[k]});
  return cones;
}

}  // namespace

PreparedSurface prepare(const Surface& surface, const EmbedOptions& options) {
  if (options.weights_file.empty()) weight_kind(surface, options.weights.kind);
  PreparedSurface prepared = {surface, {}};
  if (!surface.has_polygons()) return prepared;
  for (const WeakPlace& place : find_weak_places(surface.vertex_count(), surface.faces()))
    if (place.kind == WeakPlaceKind::degree_two || place.kind == WeakPlaceKind::double_contact)
      prepared.warnings.push_back("the mesh is not 3-connected: " + place.message);
  return prepared;
}

void require_topology(const Surface& surface, const Target& orbifold) {
  if (surface.topology == orbifold.topology) return;
  throw MeshError(
      fmt::format("the mesh is a {}, but {} needs a {}; choose an orbifold for it (see 'orbitutte types')",
                  name(surface.topology), orbifold.signature, name(orbifold.topology)));
}

void require_fit(const EmbedRequest& request) {
  const Target& orbifold = request.orbifold;
  if (request.marked_vertices.size() != orbifold.marks.size())
    throw MeshError(fmt::format("{} needs {} marked vertices, not {}", orbifold.signature,
                                orbifold.marks.size(), request.marked_vertices.size()));
  require_topology(request.prepared.surface, orbifold);
}

EdgeWeights find_weights(const EmbedRequest& request, const std::vector<int>& kept_faces,
                         KnownWeights& known) {
  const Surface& surface = request.prepared.surface;
  const EmbedOptions& options = request.options;
  if (!known.weights || known.kept_faces != kept_faces)
    known.weights = options.weights_file.empty() ? edge_weights(surface, options.weights, kept_faces)
                                                 : read_weights(options.weights_file, surface.connectivity);
  known.kept_faces = kept_faces;
  return sharpened_at_cones(*known.weights, cone_angles(request.orbifold, request.marked_vertices));
}

void find_cut(const EmbedRequest& request, const EdgeWeights& weights, EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const std::pair through(request.marked_vertices, request.orbifold.inner_marks);
  const bool is_cut = cache.cut.through == through;
  cache.cut.through.reset();
  parallel_for(2, [&](int task) {
    if (task == 0 && !is_cut)
      cache.cut.cut =
          cut_to_disk(surface, request.marked_vertices, request.orbifold.inner_marks, request.options.cut);
    if (task == 1) order_ahead(*cache.laplacians, weighted_edges(weights, surface), surface.vertex_count());
  });
  cache.cut.through = through;
}

}  // namespace orbitutte
