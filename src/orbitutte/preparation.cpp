// SPDX-License-Identifier: MIT
#include "orbitutte/preparation.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

#include "orbitutte/inspect/coincidence.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/target_words.h"
#include "orbitutte/parallel.h"
#include "orbitutte/warnings.h"
#include "orbitutte/weights/cone_weights.h"

namespace orbitutte {
namespace {

std::vector<ConeAngle> cone_angles(const Target& target, const std::vector<int>& cones) {
  const std::vector<double> angles = metric_angles(target.marks);
  std::vector<ConeAngle> result;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) result.push_back({cones[k], angles[k]});
  return result;
}

using Pairs = std::vector<std::array<int, 2>>;

// The marked vertices that come to lie at opposite points of the sphere.
Pairs opposite_vertices(const EmbedRequest& request) {
  if (!are_opposite(request.target.marks) || request.cones.size() != 2) return {};
  return {{request.cones[0], request.cones[1]}};
}

// Every arc between opposite points is as short as any other, so the place of an edge between them is not
// determined.
void require_no_edge(const Connectivity& connectivity, const Pairs& opposite, const Target& target) {
  for (const auto& [v, w] : opposite) {
    const std::array<int, 2> edge = {std::min(v, w), std::max(v, w)};
    if (!std::binary_search(connectivity.edges.begin(), connectivity.edges.end(), edge)) continue;
    throw MeshError(
        fmt::format("the marked vertices {} and {} are joined by an edge, but {} puts them at opposite "
                    "points of the sphere; mark vertices that are further apart, or split the edge",
                    v, w, target.signature));
  }
}

// The boundary of a disk, edge by edge.
Pairs boundary_edges(const Surface& disk) {
  Pairs edges;
  for (int h = 0; h < static_cast<int>(disk.connectivity.opposite.size()); ++h)
    if (disk.connectivity.opposite[h] < 0)
      edges.push_back({halfedge_origin(disk.triangles, h), halfedge_target(disk.triangles, h)});
  return edges;
}

// The smallest of the first ends.
int smallest_vertex(const Pairs& edges) { return (*std::min_element(edges.begin(), edges.end()))[0]; }

KnownWeights weights_without_cones(const Surface& surface, const EmbedOptions& options) {
  KnownWeights known;
  known.kind = options.weights.kind;
  if (!options.weights_file.empty())
    known.weights = read_weights(options.weights_file, surface.connectivity);
  else if (weight_kind(surface, options.weights.kind) == WeightKind::delaunay)
    known.edges = known.triangulation.emplace(delaunay_triangulation(surface)).connectivity.edges;
  else
    known.weights = edge_weights(surface, options.weights);
  return known;
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

void require_topology(const Surface& surface, const Target& target) {
  if (surface.topology == target.topology) return;
  if (surface.topology == Topology::disk && target.topology == Topology::sphere) {
    const Pairs hole = boundary_edges(surface);
    throw MeshError(fmt::format(
        "the mesh has a hole of {} edges, through vertex {}, which makes it a disk, but {} needs a sphere; "
        "fill the hole, or choose an orbifold for a disk, such as *{}{}",
        hole.size(), smallest_vertex(hole), target.signature, target.signature,
        in_brackets(welding_advice(find_coincidence(surface.V, hole)))));
  }
  throw MeshError(fmt::format(
      "the mesh is a {}, but {} needs a {}; choose an orbifold for a {} (see 'orbitutte types')",
      text_of(surface.topology), target.signature, text_of(target.topology), text_of(surface.topology)));
}

void require_fit(const EmbedRequest& request) {
  const Target& target = request.target;
  if (request.cones.size() != target.marks.size())
    throw MeshError(fmt::format("{} needs {} marked vertices, not {}", target.signature, target.marks.size(),
                                request.cones.size()));
  require_topology(request.prepared.surface, target);
  require_shapes(target);
  require_no_edge(request.prepared.surface.connectivity, opposite_vertices(request), target);
}

void require_no_quotient_options(const QuotientOptions& options, const std::string& onto) {
  if (options.centre || !options.points.empty())
    throw ArgumentError(fmt::format(
        "{} is no map to the whole sphere, which could be centred; ask for its quotient, or for 1 or *",
        onto));
}

EdgeWeights find_weights(const EmbedRequest& request, EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const EmbedOptions& options = request.options;
  KnownWeights& known = cache.weights;
  if (known.kind != options.weights.kind || (!known.weights && !known.triangulation))
    known = weights_without_cones(surface, options);
  if (known.weights) return *known.weights;
  const Pairs opposite = opposite_vertices(request);
  IntrinsicTriangulation T =
      cache.serves_again ? *known.triangulation : *std::exchange(known.triangulation, std::nullopt);
  T = flattened_at_cones(kept_apart(std::move(T), surface, {{}, opposite}),
                         cone_angles(request.target, request.cones));
  return intrinsic_weights(std::move(T), options.weights.clamp);
}

void find_cut(const EmbedRequest& request, EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const Target& target = request.target;
  const KnownCut::Request wanted = {request.cones, target.inner_marks, target.has_free_tile};
  const bool is_cut = cache.cut.request == wanted;
  cache.cut.request.reset();
  parallel_for(2, [&](int task) {
    if (task == 0 && !is_cut)
      cache.cut.cut = (target.has_free_tile ? cut_along_tree : cut_to_disk)(
          surface, request.cones, target.inner_marks, request.options.cut);
    if (task == 1)
      order_ahead(*cache.laplacians, cache.weights.weights ? surface.connectivity.edges : cache.weights.edges,
                  surface.vertex_count());
  });
  cache.cut.request = wanted;
}

}  // namespace orbitutte
