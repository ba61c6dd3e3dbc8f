// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/certified_map.h"
#include "orbitutte/cones/extremities.h"
#include "orbitutte/parallel.h"
#include "orbitutte/preparation.h"
#include "orbitutte/quotient/quotient.h"
#include "orbitutte/verify/energy.h"
#include "orbitutte/warnings.h"

namespace orbitutte {
namespace {

// A map with some weights, and how many vertices were moved to repair faces that these weights turn over.
struct Attempt {
  EmbedResult result;
  int repairing_vertices = 0;
};

// The method, from the surface to the certificate.
Attempt embed_once(const EmbedRequest& request, EmbeddingCache& cache) {
  const EmbedOptions& options = request.options;
  Attempt attempt;
  EmbedResult& result = attempt.result;
  Stages stage(options.progress, result.timings);
  result.threads = thread_count();
  result.backend = options.laplacian.backend;

  stage("weights", [&] { result.weights = find_weights(request, cache); });  // section 4
  const GluingProblem problem = stage("cut", [&] {                           // section 4.1
    find_cut(request, cache);
    if (!cache.serves_again) cache.weights = {};
    return gluing_problem(request, result.weights, cache.cut.cut, cache);
  });
  LbfgsOptions lbfgs;
  lbfgs.tolerance = options.tolerance;
  lbfgs.max_iterations = options.max_iterations;
  const Placement placed = place(problem, lbfgs, stage);  // (2)
  result.minimum = placed.minimum;
  attempt.repairing_vertices = finish(request, problem, {placed}, stage, result);
  return attempt;
}

// Were so many vertices moved, or is so much of the surface sheared, that the weights are at fault, and not a
// few thin triangles?
bool is_suspect(const Attempt& attempt) {
  constexpr double sheared = 10;
  const EmbedResult& result = attempt.result;
  return attempt.repairing_vertices > result.minimum.positions.rows() / 20 ||
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
  Attempt attempt = embed_once(request, cache);
  EmbedResult& first = attempt.result;
  const bool were_asked_for = options.weights.kind != WeightKind::standard || !options.weights_file.empty();
  if (were_asked_for || !first.collapsing_faces.empty() ||
      (first.certificate.bijective && !is_suspect(attempt)))
    return std::move(first);
  std::optional<EmbedResult> best;
  for (const WeightKind kind : other_weights(request.prepared.surface)) {
    EmbedOptions other = options;
    other.weights.kind = kind;
    Attempt again = embed_once({request.prepared, request.target, request.cones, other}, cache);
    EmbedResult& next = again.result;
    first.timings.insert(first.timings.end(), next.timings.begin(), next.timings.end());
    if (!next.certificate.bijective) continue;
    const bool is_good = !is_suspect(again);
    if (!best || is_good || is_better(*best, next)) best = std::move(next);
    if (is_good) break;
  }
  if (!best || !is_better(first, *best)) return std::move(first);
  best->timings = first.timings;
  best->requested_weights = first.weights.kind;
  best->warnings.push_back(warning_of_replaced_weights(first, *best));
  return std::move(*best);
}

// What a quotient is made from: a map to a target with marks, and whose they are.
struct QuotientSource {
  Target target;
  std::vector<int> cones;
};

QuotientSource quotient_source(const EmbedRequest& request) {
  if (!request.target.marks.empty()) return {request.target, request.cones};
  const Target target = quotient_base(request.target);
  return {target, choose_cones(request.prepared.surface, target)};
}

// Of the same kind as those of the map that the quotient is made from; no cone sharpens them.
EdgeWeights weights_of_quotient(const EmbedRequest& request, const EmbedResult& base, EmbeddingCache& cache) {
  EmbedOptions options = request.options;
  if (base.requested_weights) options.weights.kind = base.weights.kind;
  return find_weights({request.prepared, request.target, request.cones, options}, cache);
}

// Where the quotient lies; vertices that were put at given points are held there.
Placement placed_quotient(const GluingProblem& problem, const EmbedResult& base, const QuotientMap& quotient,
                          const std::vector<PolygonCorner>& points) {
  Placement placed = {base.minimum, problem.tile, problem.boundary, {}};
  placed.minimum.positions = quotient.positions();
  for (const PolygonCorner& held : points) {
    placed.boundary.basis_of[held.vertex] = held_in_place;
    placed.boundary.held[held.vertex] = held.position;
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
EmbedResult begin_quotient(const QuotientSource& from, const EmbedResult& base,
                           const QuotientOptions& options) {
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
  QuotientSource from;
  Target onto;
  QuotientOptions options;
};

WholeMap whole_map(const EmbedRequest& request) {
  const QuotientSource from = quotient_source(request);
  WholeMap result = {from, quotient_target(from.target), complete_options(request)};
  require_points(request.prepared.surface, result.onto, result.options.points);
  return result;
}

// The quotient of a solved map by its group.
EmbedResult quotient_by_group(const EmbedRequest& request, const WholeMap& wanted, const EmbedResult& base,
                              EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const QuotientSource& from = wanted.from;
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
  const QuotientSource& from = wanted.from;
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
