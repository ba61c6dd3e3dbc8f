// SPDX-License-Identifier: MIT
#include "orbitutte/preparation.h"

#include <fmt/format.h>

#include <array>

#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/parallel.h"
#include "orbitutte/weights/cone_weights.h"

namespace orbitutte {
namespace {

void require_weights_of_polygons(const EmbedOptions& options) {
  using enum WeightKind;
  const WeightKind kind = options.weights.kind;
  if (!options.weights_file.empty() || kind == file || kind == standard || kind == cotan || kind == uniform)
    return;
  throw ArgumentError(fmt::format(
      "{} weights are not there for faces of more than three corners; take cotan or uniform, or a "
      "file of weights",
      name(kind)));
}

// The edges that have the weights: the mesh's, or those of a triangulation of its surface.
const std::vector<std::array<int, 2>>& weighted_edges(const EdgeWeights& weights,
                                                      const Connectivity& connectivity) {
  return weights.triangulation ? weights.triangulation->connectivity.edges : connectivity.edges;
}

std::vector<ConeAngle> cone_angles(const Target& orbifold, const std::vector<int>& marked_vertices) {
  const std::vector<double> angles = metric_angles(orbifold.marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) cones.push_back({marked_vertices[k], angles[k]});
  return cones;
}

}  // namespace

Mesh prepare(const PolygonMesh& mesh, const EmbedOptions& options, Preparation& prepared) {
  require_weights_of_polygons(options);
  DividedMesh divided = divide(mesh);
  prepared.surface = std::move(divided.surface);
  prepared.polygons = std::move(divided.triangulation);
  for (const WeakPlace& place : find_weak_places(mesh))
    if (place.kind == WeakPlaceKind::degree_two || place.kind == WeakPlaceKind::double_contact)
      prepared.warnings.push_back("the mesh is not 3-connected: " + place.message);
  return std::move(divided.triangles);
}

void require_topology(Topology topology, const Target& orbifold) {
  if (topology == orbifold.topology) return;
  throw MeshError(
      fmt::format("the mesh is a {}, but {} needs a {}; choose an orbifold for it (see 'orbitutte types')",
                  name(topology), orbifold.signature, name(orbifold.topology)));
}

void find_surface(const EmbedRequest& request, Preparation& prepared) {
  if (!prepared.surface) prepared.surface = require_surface(request.mesh);
  require_topology(prepared.surface->topology, request.orbifold);
}

EdgeWeights find_weights(const EmbedRequest& request, Preparation& prepared) {
  const auto& [mesh, orbifold, marked_vertices, options] = request;
  const Connectivity& connectivity = prepared.surface->connectivity;
  if (!prepared.weights || prepared.kept_faces != options.weights.kept_faces)
    prepared.weights = options.weights_file.empty() ? edge_weights(mesh, connectivity, options.weights)
                                                    : read_weights(options.weights_file, connectivity);
  prepared.kept_faces = options.weights.kept_faces;
  return sharpened_at_cones(*prepared.weights, cone_angles(orbifold, marked_vertices));
}

void find_cut(const EmbedRequest& request, const EdgeWeights& weights, Preparation& prepared) {
  const auto& [mesh, orbifold, marked_vertices, options] = request;
  const Connectivity& connectivity = prepared.surface->connectivity;
  const std::pair through(marked_vertices, orbifold.inner_marks);
  const bool is_cut = prepared.cut_through == through;
  prepared.cut_through.reset();
  parallel_for(2, [&](int task) {
    if (task == 0 && !is_cut)
      prepared.cut = cut_to_disk(request.mesh, connectivity, request.marked_vertices,
                                 request.orbifold.inner_marks, request.options.cut);
    if (task == 1)
      order_ahead(*prepared.laplacians, weighted_edges(weights, connectivity),
                  static_cast<int>(request.mesh.V.rows()));
  });
  prepared.cut_through = through;
}

}  // namespace orbitutte
