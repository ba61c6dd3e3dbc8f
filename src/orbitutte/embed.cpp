// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/orbifold/free_tile.h"
#include "orbitutte/parallel.h"
#include "orbitutte/preparation.h"
#include "orbitutte/quotient/quotient.h"
#include "orbitutte/solve/remedies.h"
#include "orbitutte/verify/energy.h"
#include "orbitutte/warnings.h"

namespace orbitutte {
namespace {

// What did not converge is not certified.
void refuse(Certificate& certificate, const Minimum& minimum, double tolerance) {
  certificate.bijective = false;
  certificate.checks.push_back(
      {"converged", false, minimum.gradient_norm, tolerance, "the optimiser stopped before it converged"});
}

// The gluing problem of the surface that is cut.
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

using Remedy = std::function<std::optional<SpreadMap>(const GluingProblem&, const Placement&)>;

// A map that was placed, and what is tried, in this order, if it is no bijection in doubles.
struct PlacedMap {
  const Placement& placed;
  std::vector<Remedy> remedies = {with_faces_repaired, with_tips_unrolled, with_limbs_resolved,
                                  with_more_digits};
};

// Takes what the remedy finds if it is a bijection.
bool helps(const Remedy& remedy, const GluingProblem& problem, const Placement& placed, EmbedResult& result) {
  const std::optional<SpreadMap> map = remedy(problem, placed);
  if (!map) return false;
  EmbedResult mended;
  take(problem, *map, mended);
  if (!mended.certificate.bijective) return false;
  result.embedding = std::move(mended.embedding);
  result.moved_vertices = std::move(mended.moved_vertices);
  result.certificate = std::move(mended.certificate);
  result.minimum.positions = map->placed.minimum.positions;
  result.minimum.energy = energy_of(problem, map->placed);
  return true;
}

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

// The first remedy that makes the map a bijection is taken. Faces that must become arcs are beyond all
// remedies; to look for them takes longer than to try the first.
void mend(const EmbedRequest& request, const GluingProblem& problem, const PlacedMap& map,
          EmbedResult& result) {
  const auto is_mended = [&](const Remedy& remedy) { return helps(remedy, problem, map.placed, result); };
  if (is_mended(map.remedies.front())) return;
  std::vector<int> collapsing = faces_that_must_collapse(request, problem, map.placed);
  if (is_hopeless(collapsing, ears_of(problem, map.placed)))
    result.collapsing_faces = std::move(collapsing);
  else
    std::any_of(map.remedies.begin() + 1, map.remedies.end(), is_mended);
}

// From the map that was placed to the result: certified, mended where it is no bijection, and measured.
void finish(const EmbedRequest& request, const GluingProblem& problem, const PlacedMap& map, Stages& stage,
            EmbedResult& result) {
  const Surface& surface = request.prepared.surface;
  const Placement& placed = map.placed;
  const bool has_converged = placed.minimum.termination == Termination::converged;
  const auto needs_mending = [&] { return has_converged && !result.certificate.bijective; };
  stage("certify", [&] {
    // A map that turns faces over is mended before it is certified.
    const SpreadMap spread = spread_map(problem, placed);
    if (!has_converged || !turns_faces_over(problem, spread)) take(problem, spread, result);
    if (!needs_mending()) judge(request, result);
  });
  if (needs_mending()) {
    stage("mend", [&] { mend(request, problem, map, result); });
    stage("certify", [&] {
      if (result.certificate.checks.empty()) take(problem, spread_map(problem, placed), result);
      judge(request, result);
    });
  }

  result.warnings = warnings_of(request, problem, placed, result);
  result.topology = surface.topology;
  result.unreferenced_vertices = surface.unreferenced_vertices;
  result.zero_area_faces = surface.zero_area_faces;
}

// The method, from the surface to the certificate.
EmbedResult embed_once(const EmbedRequest& request, EmbeddingCache& cache) {
  const EmbedOptions& options = request.options;
  EmbedResult result;
  Stages stage(options.progress, result.timings);
  result.threads = thread_count();
  result.backend = options.laplacian.backend;

  stage("weights", [&] { result.weights = find_weights(request, cache.weights); });  // section 4
  stage("cut", [&] { find_cut(request, cache); });                                   // section 4.1
  if (!cache.serves_again) cache.weights = {};
  const GluingProblem problem = gluing_problem(request, result.weights, cache.cut.cut, cache);
  LbfgsOptions lbfgs;
  lbfgs.tolerance = options.tolerance;
  lbfgs.max_iterations = options.max_iterations;
  const Placement placed = place(problem, lbfgs, stage);  // (2)
  result.minimum = placed.minimum;
  finish(request, problem, {placed}, stage, result);
  return result;
}

// Weights that are tried, in this order, where the standard ones give no bijection.
std::vector<WeightKind> other_weights(const Surface& surface) {
  if (surface.has_polygons()) return {WeightKind::uniform};
  if (surface.zero_area_faces > 0) return {WeightKind::mean_value, WeightKind::uniform};  // no cotangents
  return {WeightKind::cotan, WeightKind::mean_value, WeightKind::uniform};
}

// Were so many vertices moved, or is so much of the surface sheared, that the weights are at fault, and not a
// few thin triangles?
bool is_suspect(const EmbedResult& result) {
  constexpr double sheared = 10;
  return static_cast<int>(result.moved_vertices.size()) > result.minimum.positions.rows() / 20 ||
         result.distortion.angle.area_mean > sheared;
}

// Is the second map so much better that it is taken in place of the first?
bool is_better(const EmbedResult& first, const EmbedResult& second) {
  if (first.certificate.bijective != second.certificate.bijective) return second.certificate.bijective;
  return second.distortion.angle.area_mean - 1 < 0.5 * (first.distortion.angle.area_mean - 1);
}

// Where no weights were asked for and the standard ones give no bijection, or one that is suspect: the first
// others that give one that is not, unless the first map is about as good.
EmbedResult embed_with_some_weights(const EmbedRequest& request, EmbeddingCache& cache) {
  const EmbedOptions& options = request.options;
  EmbedResult first = embed_once(request, cache);
  const bool were_asked_for = options.weights.kind != WeightKind::standard || !options.weights_file.empty();
  if (were_asked_for || !first.collapsing_faces.empty() ||
      (first.certificate.bijective && !is_suspect(first)))
    return first;
  std::optional<EmbedResult> best;
  for (const WeightKind kind : other_weights(request.prepared.surface)) {
    EmbedOptions other = options;
    other.weights.kind = kind;
    EmbedResult next = embed_once({request.prepared, request.target, request.cones, other}, cache);
    first.timings.insert(first.timings.end(), next.timings.begin(), next.timings.end());
    if (!next.certificate.bijective) continue;
    const bool is_good = !is_suspect(next);
    if (!best || is_good || is_better(*best, next)) best = std::move(next);
    if (is_good) break;
  }
  if (!best || !is_better(first, *best)) return first;
  best->timings = first.timings;
  best->requested_weights = first.weights.kind;
  best->warnings.push_back(warning_of_replaced_weights(first, *best));
  return std::move(*best);
}

// What a quotient is made from: a map to a target with marks, and whose they are.
struct BaseMap {
  Target target;
  std::vector<int> cones;
};

BaseMap base_map(const EmbedRequest& request) {
  if (!request.target.marks.empty()) return {request.target, request.cones};
  const Target target = quotient_base(request.target);
  return {target, choose_cones(request.prepared.surface, target)};
}

// Of the same kind as those of the map that the quotient is made from; no cone sharpens them.
EdgeWeights weights_of_quotient(const EmbedRequest& request, const EmbedResult& base, EmbeddingCache& cache) {
  EmbedOptions options = request.options;
  if (base.requested_weights) options.weights.kind = base.weights.kind;
  return find_weights({request.prepared, request.target, request.cones, options}, cache.weights);
}

// Where the quotient lies; vertices that were put at given points are held there.
Placement placed_quotient(const GluingProblem& problem, const EmbedResult& base, const QuotientMap& quotient,
                          const std::vector<PolygonCorner>& points) {
  Placement placed = {base.minimum, problem.tile, problem.boundary, {}};
  placed.minimum.positions = quotient.positions();
  for (const PolygonCorner& held : points) {
    placed.boundary.basis_of[held.vertex] = held_in_place;
    placed.boundary.held.row(held.vertex) = held.position.transpose();
  }
  placed.boundary.make_feasible(placed.minimum.positions);
  return placed;
}

// Vertices that were mended have moved the centre of mass, too: by as little, the map is centred again, if it
// stays certified.
void centre_again(const Surface& surface, EmbedResult& result) {
  const bool is_mended = !result.moved_vertices.empty() || !result.embedding.offsets.empty() ||
                         !result.embedding.placement.is_identity();
  if (!result.certificate.bijective || !is_mended || !result.quotient->points.empty()) return;
  Embedding centred = result.embedding;
  centre_anew(surface, result.quotient->centre, centred);
  Certificate certificate = certify(surface, centred);
  if (!certificate.bijective) return;
  result.embedding = std::move(centred);
  result.certificate = std::move(certificate);
  result.distortion = measure_distortion(surface, result.embedding);
}

// The options, with the centre that is meant if none is asked for.
QuotientOptions complete_options(const EmbedRequest& request) {
  QuotientOptions options = request.options.quotient;
  if (!options.centre) options.centre = request.target.marks.empty() ? Centre::area : Centre::none;
  return options;
}

// What is known of the quotient before it is computed.
EmbedResult begin_quotient(const BaseMap& from, const EmbedResult& base, const QuotientOptions& options) {
  EmbedResult result;
  result.timings = base.timings;
  result.threads = base.threads;
  result.backend = base.backend;
  result.requested_weights = base.requested_weights;
  result.quotient = {from.target.signature, from.cones, *options.centre, options.points};
  return result;
}

// Limbs have digits of their own; only if these do not do are they settled at the minimum of the energy.
std::vector<Remedy> remedies_of(const QuotientMap& quotient) {
  const auto with_its_digits = [&](const GluingProblem& problem, const Placement& placed) {
    return with_digits_of([&](int v) { return quotient.precise_position(v); }, problem, placed);
  };
  return {with_faces_repaired, with_its_digits, with_limbs_resolved, with_more_digits};
}

// The map onto all that the quotient of a map to `from` is onto. It marks nothing, but the vertices that the
// other map marks keep what it spreads out from becoming an arc.
struct WholeMap {
  BaseMap from;
  Target onto;
  QuotientOptions options;
};

WholeMap whole_map(const EmbedRequest& request) {
  const BaseMap from = base_map(request);
  WholeMap result = {from, quotient_target(from.target), complete_options(request)};
  require_points(request.prepared.surface, result.onto, result.options.points);
  return result;
}

// The quotient of a solved map by its group.
EmbedResult quotient_by_group(const EmbedRequest& request, const WholeMap& wanted, const EmbedResult& base,
                              EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const BaseMap& from = wanted.from;
  const Target& onto = wanted.onto;
  const QuotientOptions& options = wanted.options;
  const EmbedRequest whole = {request.prepared, onto, from.cones, request.options};

  EmbedResult result = begin_quotient(from, base, options);
  Stages stage(request.options.progress, result.timings);
  result.weights = stage("weights", [&] { return weights_of_quotient(whole, base, cache); });
  const CutMesh cut = stage("cut", [&] { return cut_to_disk(surface, {}, 0, request.options.cut); });
  const GluingProblem problem = gluing_problem(whole, result.weights, cut, cache);
  const QuotientMap quotient =
      stage("quotient", [&] { return QuotientMap(surface, base.embedding, onto, options); });
  const Placement placed = placed_quotient(problem, base, quotient, options.points);
  result.minimum = placed.minimum;
  finish(whole, problem, {placed, remedies_of(quotient)}, stage, result);
  stage("centre", [&] {
    centre_again(surface, result);
    result.minimum.positions = result.embedding.positions.topRows(surface.vertex_count());
    result.minimum.energy = dirichlet_energy(surface, result.weights, result.embedding);
  });
  if (base.requested_weights) result.warnings.push_back(base.warnings.back());
  return result;
}

EmbedResult embed_quotient(const EmbedRequest& request, EmbeddingCache& cache) {
  const WholeMap wanted = whole_map(request);
  const BaseMap& from = wanted.from;
  cache.serves_again = true;
  const EmbedResult base =
      embed_with_some_weights({request.prepared, from.target, from.cones, request.options}, cache);
  return quotient_by_group(request, wanted, base, cache);
}

// Runs `compute` with the threads that the options ask for.
template <typename Compute>
auto with_threads_of(const EmbedOptions& options, const Compute& compute) {
  if (options.threads < 0) throw ArgumentError("the number of threads must not be negative");
  return with_threads(options.threads, compute);
}

// Validates, as the first stage, what is then embedded. validate() returns the prepared surface.
template <typename Validate>
EmbedResult embed_validated(const Validate& validate, const Target& target, const std::vector<int>& cones,
                            const EmbedOptions& options, EmbeddingCache& cache) {
  return with_threads_of(options, [&] {
    Timings timings;
    Stages stage(options.progress, timings);
    const PreparedSurface prepared = stage("validate", validate);
    const EmbedRequest request = {prepared, target, cones, options};
    require_fit(request);
    const bool is_quotient = target.marks.empty() || options.quotient.is_wanted;
    if (!is_quotient) require_no_quotient_options(options.quotient, target.signature);
    EmbedResult result =
        is_quotient ? embed_quotient(request, cache) : embed_with_some_weights(request, cache);
    result.timings.insert(result.timings.begin(), timings.begin(), timings.end());
    return result;
  });
}

template <typename AnyMesh>
EmbedResult embed_mesh(const AnyMesh& mesh, const Target& target, const std::vector<int>& cones,
                       const EmbedOptions& options) {
  Surface surface;
  const auto validate = [&] {
    surface = make_surface(mesh);
    return prepare(surface, options);
  };
  EmbeddingCache cache(Kept::order);
  return embed_validated(validate, target, cones, options, cache);
}

}  // namespace

EmbedResult embed(const Surface& surface, const Target& target, const std::vector<int>& cones,
                  const EmbedOptions& options) {
  const auto validate = [&] { return prepare(surface, options); };
  EmbeddingCache cache(Kept::order);
  return embed_validated(validate, target, cones, options, cache);
}

EmbedResult embed(const Mesh& mesh, const Target& target, const std::vector<int>& cones,
                  const EmbedOptions& options) {
  return embed_mesh(mesh, target, cones, options);
}

EmbedResult embed(const PolygonMesh& mesh, const Target& target, const std::vector<int>& cones,
                  const EmbedOptions& options) {
  return embed_mesh(mesh, target, cones, options);
}

EmbedResult quotient_of(const Surface& surface, const EmbedResult& map, const EmbedOptions& options) {
  return with_threads_of(options, [&] {
    const PreparedSurface prepared = prepare(surface, options);
    std::vector<int> cones;
    for (const ConeCopies& cone : map.embedding.cones) cones.push_back(cone.vertex);
    const EmbedRequest request = {prepared, map.embedding.target, cones, options};
    require_fit(request);
    EmbeddingCache cache(Kept::order);
    return quotient_by_group(request, whole_map(request), map, cache);
  });
}

struct EmbeddingSolver::State {
  std::shared_ptr<const Surface> surface;
  EmbedOptions options;
  PreparedSurface prepared;  // refers to the surface
  EmbeddingCache cache;
};

EmbeddingSolver::EmbeddingSolver(std::shared_ptr<const Surface> surface, EmbedOptions options) {
  PreparedSurface prepared = prepare(*surface, options);
  state_ = std::make_unique<State>(
      State{std::move(surface), std::move(options), std::move(prepared), EmbeddingCache(Kept::factors)});
}

EmbeddingSolver::EmbeddingSolver(Surface surface, EmbedOptions options)
    : EmbeddingSolver(std::make_shared<const Surface>(std::move(surface)), std::move(options)) {}

EmbeddingSolver::EmbeddingSolver(Mesh mesh, const EmbedOptions& options)
    : EmbeddingSolver(with_threads_of(options, [&] { return make_surface(std::move(mesh)); }), options) {}

EmbeddingSolver::EmbeddingSolver(PolygonMesh mesh, const EmbedOptions& options)
    : EmbeddingSolver(with_threads_of(options, [&] { return make_surface(std::move(mesh)); }), options) {}

EmbeddingSolver::~EmbeddingSolver() = default;
EmbeddingSolver::EmbeddingSolver(EmbeddingSolver&&) noexcept = default;

EmbedResult EmbeddingSolver::embed(const Target& target, const std::vector<int>& cones) {
  State& state = *state_;
  const auto validate = [&] { return state.prepared; };
  return embed_validated(validate, target, cones, state.options, state.cache);
}

std::vector<int> choose_cones(const Surface& surface, const Target& target) {
  require_topology(surface, target);
  const int outer = static_cast<int>(target.marks.size()) - target.inner_marks;
  return choose_extremities(surface, {target.inner_marks, outer, are_opposite(target.marks)});
}

std::vector<int> choose_cones(const Mesh& mesh, const Target& target) {
  return choose_cones(make_surface(mesh), target);
}

std::vector<int> choose_cones(const PolygonMesh& mesh, const Target& target) {
  return choose_cones(make_surface(mesh), target);
}

}  // namespace orbitutte
