// SPDX-License-Identifier: MIT
#include "orbitutte/preparation.h"

#include <fmt/format.h>

#include <array>

#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/parallel.h"
#include "orbitutte/warnings.h"
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

struct Hole {
  int edges = 0;
  int vertex = -1;  // the smallest on its boundary
};

// The one hole of a disk.
Hole hole_of(const Surface& disk) {
  Hole hole;
  for (int h = 0; h < static_cast<int>(disk.connectivity.opposite.size()); ++h) {
    if (disk.connectivity.opposite[h] >= 0) continue;
    ++hole.edges;
    const int vertex = origin(disk.triangles, h);
    if (hole.vertex < 0 || vertex < hole.vertex) hole.vertex = vertex;
  }
  return hole;
}

}  // namespace

PreparedSurface prepare(const Surface& surface, const EmbedOptions& options) {
  if (options.weights_file.empty()) weight_kind(surface, options.weights.kind);
  PreparedSurface prepared = {surface, warnings_of_orientation(surface)};
  if (!surface.has_polygons()) return prepared;
  for (const WeakPlace& place : find_weak_places(surface.vertex_count(), surface.faces()))
    if (place.kind == WeakPlaceKind::degree_two || place.kind == WeakPlaceKind::double_contact)
      prepared.warnings.push_back("the mesh is not 3-connected: " + place.message);
  return prepared;
}

void require_topology(const Surface& surface, const Target& orbifold) {
  if (surface.topology == orbifold.topology) return;
  if (surface.topology == Topology::disk && orbifold.topology == Topology::sphere) {
    const auto [edges, vertex] = hole_of(surface);
    throw MeshError(fmt::format(
        "the mesh has a hole of {} edges, through vertex {}, which makes it a disk, but {} needs a sphere; "
        "fill the hole, or choose an orbifold for a disk, such as *{}",
        edges, vertex, orbifold.signature, orbifold.signature));
  }
  throw MeshError(fmt::format(
      "the mesh is a {}, but {} needs a {}; choose an orbifold for a {} (see 'orbitutte types')",
      name(surface.topology), orbifold.signature, name(orbifold.topology), name(surface.topology)));
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
