// SPDX-License-Identifier: MIT
#include "orbitutte/preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "orbitutte/inspect/coincidence.h"
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

std::vector<ConeAngle> cone_angles(const Orbifold& orbifold, const std::vector<int>& marked_vertices) {
  const std::vector<double> angles = metric_angles(orbifold.marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) cones.push_back({marked_vertices[k], angles[k]});
  return cones;
}

using Pairs = std::vector<std::array<int, 2>>;

// The marked vertices that come to lie at opposite points of the sphere.
Pairs opposite_vertices(const EmbedRequest& request) {
  if (!are_opposite(request.orbifold.marks) || request.marked_vertices.size() != 2) return {};
  return {{request.marked_vertices[0], request.marked_vertices[1]}};
}

// Every arc between opposite points is as short as any other, so that an edge between them has no place.
void require_no_edge(const Connectivity& connectivity, const Pairs& opposite, const Orbifold& orbifold) {
  for (const auto& [v, w] : opposite) {
    const std::array<int, 2> edge = {std::min(v, w), std::max(v, w)};
    if (!std::binary_search(connectivity.edges.begin(), connectivity.edges.end(), edge)) continue;
    throw MeshError(
        fmt::format("the marked vertices {} and {} are joined by an edge, but {} puts them at opposite "
                    "points of the sphere; mark vertices that are further apart, or split the edge",
                    v, w, orbifold.signature));
  }
}

Pairs boundary_edges(const Faces& F, const Connectivity& connectivity) {
  Pairs edges;
  for (int h = 0; h < static_cast<int>(F.size()); ++h)
    if (connectivity.opposite[h] < 0) edges.push_back({origin(F, h), target(F, h)});
  return edges;
}

int smallest_vertex(const Pairs& edges) {
  const auto first = std::min_element(edges.begin(), edges.end(), [](const auto& a, const auto& b) {
    return std::min(a[0], a[1]) < std::min(b[0], b[1]);
  });
  return std::min((*first)[0], (*first)[1]);
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

void require_topology(const Mesh& mesh, const SoundSurface& surface, const Orbifold& orbifold) {
  if (surface.topology == orbifold.topology) return;
  const auto boundary = boundary_edges(mesh.F, surface.connectivity);
  const bool is_open = surface.topology == Topology::disk && orbifold.topology == Topology::sphere;
  const std::string filled = is_open ? fmt::format("fill its hole of {} edges through vertex {}, or ",
                                                   boundary.size(), smallest_vertex(boundary))
                                     : "";
  throw MeshError(fmt::format(
      "the mesh is a {}, but {} needs a {}; {}choose an orbifold for it (see 'orbitutte types'){}",
      name(surface.topology), orbifold.signature, name(orbifold.topology), filled,
      is_open ? in_brackets(welding_advice(find_coincidence(mesh.V, boundary))) : ""));
}

void find_surface(const EmbedRequest& request, Preparation& prepared) {
  if (!prepared.surface) prepared.surface = require_surface(request.mesh);
  require_topology(request.mesh, *prepared.surface, request.orbifold);
  require_no_edge(prepared.surface->connectivity, opposite_vertices(request), request.orbifold);
}

EdgeWeights find_weights(const EmbedRequest& request, Preparation& prepared) {
  const auto& [mesh, orbifold, marked_vertices, options] = request;
  const Connectivity& connectivity = prepared.surface->connectivity;
  if (!prepared.weights || prepared.kept_faces != options.weights.kept_faces)
    prepared.weights = options.weights_file.empty() ? edge_weights(mesh, connectivity, options.weights)
                                                    : read_weights(options.weights_file, connectivity);
  prepared.kept_faces = options.weights.kept_faces;
  const Pairs apart = opposite_vertices(request);
  return sharpened_at_cones(kept_apart(*prepared.weights, apart, mesh, connectivity, options.weights),
                            cone_angles(orbifold, marked_vertices), apart);
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
