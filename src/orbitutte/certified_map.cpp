// SPDX-License-Identifier: MIT
#include "orbitutte/certified_map.h"

#include <algorithm>
#include <utility>

#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/orbifold/tile.h"
#include "orbitutte/warnings.h"

namespace orbitutte {
namespace {

// What did not converge is not certified.
void refuse(Certificate& certificate, const Minimum& minimum, double tolerance) {
  certificate.bijective = false;
  certificate.checks.push_back(
      {"converged", false, minimum.gradient_norm, tolerance, "the optimiser stopped before it converged"});
}

// The minimum that was placed, as an embedding.
Embedding embedding_of(const GluingProblem& problem, const SpreadMap& map) {
  const CutMesh& cut = problem.cut;
  const BoundaryConditions& boundary = map.placed.boundary;
  return {problem.target,    map.placed.frame, map.positions,  cut.F,
          cut.source_vertex, boundary.seams,   boundary.cones, problem.surface.polygons_on(cut.F, cut.turned),
          map.offsets};
}

void append(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

// Puts the map into the result, with its certificate.
void take(const GluingProblem& problem, const SpreadMap& map, EmbedResult& result) {
  result.embedding = embedding_of(problem, map);
  result.moved_vertices = map.moved_vertices;
  result.certificate = certify(problem.surface, result.embedding);
}

// A map that is to become a bijection, and where that is put.
struct Mending {
  const GluingProblem& problem;
  const Placement& placed;
  Stages& stage;
  EmbedResult& result;
  int& repairing_vertices;

  // Takes what the remedy finds, in the stage of that name, if it is a bijection.
  bool succeeds(const char* name, const Remedy& remedy) const {
    const std::optional<SpreadMap> map = stage(name, [&] { return remedy(problem, placed); });
    if (!map) return false;
    EmbedResult mended;
    stage("certify", [&] { take(problem, *map, mended); });
    if (!mended.certificate.bijective) return false;
    result.embedding = std::move(mended.embedding);
    result.moved_vertices = std::move(mended.moved_vertices);
    repairing_vertices = map->repairing_vertices;
    result.certificate = std::move(mended.certificate);
    result.minimum.positions = map->placed.minimum.positions;
    result.minimum.energy = energy_of(problem, map->placed);
    return true;
  }
};

// What else is known of the map in the result.
void judge(const EmbedRequest& request, EmbedResult& result) {
  const Surface& surface = request.prepared.surface;
  if (!result.certificate.bijective && result.weights.triangulation)
    result.intrinsic_certificate =
        certify_intrinsic(surface, result.embedding, *result.weights.triangulation);
  result.distortion = measure_distortion(surface, result.embedding);
  if (result.minimum.termination == Termination::converged) return;
  refuse(result.certificate, result.minimum, request.options.tolerance);
  if (result.intrinsic_certificate)
    refuse(*result.intrinsic_certificate, result.minimum, request.options.tolerance);
}

std::vector<int> faces_that_must_collapse(const EmbedRequest& request, const GluingProblem& problem,
                                          const Placement& placed) {
  const auto mirrors = mirrors_of(placed.tile, placed.boundary, problem.cut.source_vertex);
  return collapsing_faces(problem.surface.faces(), mirrors, request.cones);
}

// Ears alone are rounded outward; what else must collapse cannot be helped.
bool is_hopeless(const std::vector<int>& collapsing, const std::vector<Ear>& ears) {
  return static_cast<int>(collapsing.size()) > count_faces(ears);
}

// The first remedy that makes the map a bijection is taken. Faces that must become arcs are beyond all
// remedies; to look for them takes longer than to try the first.
void mend(const EmbedRequest& request, const std::vector<Remedy>& remedies, const Mending& mending) {
  const auto is_mended = [&](const Remedy& remedy) { return mending.succeeds("mend", remedy); };
  if (is_mended(remedies.front())) return;
  const bool is_hopeful = mending.stage("mend", [&] {
    std::vector<int> collapsing = faces_that_must_collapse(request, mending.problem, mending.placed);
    if (!is_hopeless(collapsing, ears_of(mending.problem, mending.placed))) return true;
    mending.result.collapsing_faces = std::move(collapsing);
    return false;
  });
  if (is_hopeful) std::any_of(remedies.begin() + 1, remedies.end(), is_mended);
}

// Warnings about the map in the result.
std::vector<std::string> warnings_of(const EmbedRequest& request, const GluingProblem& problem,
                                     const Placement& placed, const EmbedResult& result) {
  std::vector<std::string> warnings = warnings_about(result.weights, ears_of(problem, placed));
  append(request.prepared.warnings, warnings);
  append(warnings_of_collapse(problem.surface.faces(), result.collapsing_faces,
                              result.certificate.nonpositive_faces),
         warnings);
  return warnings;
}

}  // namespace

GluingProblem gluing_problem(const EmbedRequest& request, const EdgeWeights& weights, const CutMesh& cut,
                             const EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const Tile tile = request.target.has_free_tile ? any_tile(request.target, cut)
                                                 : basic_tile(request.target, cut.arrangement);  // appendix A
  return {surface,
          cut,
          request.target,
          weights,
          {request.options.laplacian, cache.laplacians},
          tile,
          boundary_conditions(surface, cut, tile, request.target, request.options.spread)};
}

std::vector<WeightKind> other_weights(const Surface& surface) {
  if (surface.has_polygons()) return {WeightKind::uniform};
  if (surface.zero_area_faces > 0) return {WeightKind::mean_value, WeightKind::uniform};  // no cotangents
  return {WeightKind::cotan, WeightKind::mean_value, WeightKind::uniform};
}

int finish(const EmbedRequest& request, const GluingProblem& problem, const PlacedMap& map, Stages& stage,
           EmbedResult& result) {
  const Surface& surface = request.prepared.surface;
  const Placement& placed = map.placed;
  const bool has_converged = placed.minimum.termination == Termination::converged;
  const auto needs_mending = [&] { return has_converged && !result.certificate.bijective; };
  int repairing_vertices = 0;
  const Mending mending = {problem, placed, stage, result, repairing_vertices};
  const bool is_refined = has_converged && map.refinement && mending.succeeds("refine", map.refinement);
  stage("certify", [&] {
    // A map that turns faces over is mended before it is certified.
    if (!is_refined)
      if (const SpreadMap spread = spread_map(problem, placed);
          !has_converged || !turns_faces_over(problem, spread))
        take(problem, spread, result);
    if (!needs_mending()) judge(request, result);
  });
  if (needs_mending()) {
    mend(request, map.remedies, mending);
    stage("certify", [&] {
      if (result.certificate.checks.empty()) take(problem, spread_map(problem, placed), result);
      judge(request, result);
    });
  }

  result.warnings = warnings_of(request, problem, placed, result);
  result.topology = surface.topology;
  result.unreferenced_vertices = surface.unreferenced_vertices;
  result.zero_area_faces = surface.zero_area_faces;
  return repairing_vertices;
}

}  // namespace orbitutte
