// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <algorithm>
#include <numeric>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/parallel.h"
#include "orbitutte/preparation.h"
#include "orbitutte/solve/placement.h"
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
GluingProblem gluing_problem(const EmbedRequest& request, const EdgeWeights& weights,
                             const EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  const CutMesh& cut = cache.cut.cut;
  const Tile tile = basic_tile(request.target, cut.arrangement);  // appendix A
  return {surface,
          cut,
          request.target,
          weights,
          {request.options.laplacian, cache.laplacians},
          tile,
          boundary_conditions(surface, cut, tile, request.target, request.options.spread)};
}

// Certificate and distortion of result.embedding.
void judge(const EmbedRequest& request, EmbedResult& result) {
  const Surface& surface = request.prepared.surface;
  result.certificate = certify(surface, result.embedding);
  if (!result.certificate.bijective && result.weights.triangulation)
    result.intrinsic_certificate =
        certify_intrinsic(surface, result.embedding, *result.weights.triangulation);
  result.distortion = measure_distortion(surface, result.embedding);
  if (result.minimum.termination == Termination::converged) return;
  refuse(result.certificate, result.minimum, request.options.tolerance);
  if (result.intrinsic_certificate)
    refuse(*result.intrinsic_certificate, result.minimum, request.options.tolerance);
}

void append(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

// The method, from the surface to the certificate. kept_faces: see find_weights.
EmbedResult embed_once(const EmbedRequest& request, const std::vector<int>& kept_faces,
                       EmbeddingCache& cache) {
  const auto& [prepared, target, cones, options] = request;
  const Surface& surface = prepared.surface;
  EmbedResult result;
  Stages stage(options.progress, result.timings);
  result.threads = thread_count();
  result.backend = options.laplacian.backend;

  stage("weights", [&] { result.weights = find_weights(request, kept_faces, cache.weights); });  // section 4
  stage("cut", [&] { find_cut(request, result.weights, cache); });  // section 4.1
  const CutMesh& cut = cache.cut.cut;

  LbfgsOptions lbfgs;
  lbfgs.tolerance = options.tolerance;
  lbfgs.max_iterations = options.max_iterations;
  Placement placed = place(gluing_problem(request, result.weights, cache), lbfgs, stage);  // (2)
  result.minimum = std::move(placed.minimum);
  const Tile& tile = placed.tile;
  const BoundaryConditions& boundary = placed.boundary;

  result.embedding = {target,
                      placed.frame,
                      Points(),
                      cut.F,
                      cut.source_vertex,
                      boundary.seams,
                      boundary.cones,
                      surface.polygons_on(cut.F, cut.turned)};
  const std::vector<Ear> ears = find_ears(result.embedding.faces(), tile, boundary);
  round_outward(ears, result.minimum.positions);
  result.embedding.positions = boundary.spread(result.minimum.positions, cut.source_vertex);
  stage("certify", [&] { judge(request, result); });

  result.warnings = warnings_about(result.weights, ears);
  append(prepared.warnings, result.warnings);
  if (const std::vector<int>& nonpositive = result.certificate.nonpositive_faces; !nonpositive.empty()) {
    const auto mirrors = mirrors_of(tile, boundary, cut.source_vertex);
    const std::vector<int> collapsing = collapsing_faces(surface.faces(), mirrors, cones);
    append(warnings_of_collapse(surface.faces(), collapsing, nonpositive), result.warnings);
  }
  result.topology = surface.topology;
  result.unreferenced_vertices = surface.unreferenced_vertices;
  result.zero_area_faces = surface.zero_area_faces;
  return result;
}

// Can it help to keep the faces that the result turns over? Where they are many, it is double precision that
// does not resolve them.
bool may_keep_faces(const EmbedResult& result) {
  const auto turned = static_cast<Eigen::Index>(result.certificate.nonpositive_faces.size());
  return result.weights.triangulation && result.minimum.termination == Termination::converged && turned > 0 &&
         turned <= 1 + result.embedding.triangles.rows() / 50;
}

// `kept` with the faces that share a vertex with one of `faces`; ascending.
std::vector<int> with_faces_around(const std::vector<int>& faces, const std::vector<int>& kept,
                                   const Surface& surface) {
  const Triangles& F = surface.triangles;
  std::vector<char> near(surface.V.rows(), 0), chosen(F.rows(), 0);
  for (const int f : kept) chosen[f] = 1;
  for (const int f : faces)
    for (const int v : F.row(f)) near[v] = 1;
  std::vector<int> result;
  for (int f = 0; f < static_cast<int>(F.rows()); ++f)
    if (chosen[f] || near[F(f, 0)] || near[F(f, 1)] || near[F(f, 2)]) result.push_back(f);
  return result;
}

std::vector<int> all_faces(const Triangles& F) {
  std::vector<int> faces(F.rows());
  std::iota(faces.begin(), faces.end(), 0);
  return faces;
}

// The triangulation that has the weights may be embedded while thin triangles of the input, which are not
// among its faces, are turned over. Then those and the faces around them become faces of it, and the map is
// computed again, up to a few times; at last with all faces kept, which leaves the paper's weights but for
// the cones. The first that is certified is the result; where none is, the very first.
EmbedResult embed_or_keep_faces(const EmbedRequest& request, EmbeddingCache& cache) {
  const Surface& surface = request.prepared.surface;
  constexpr int attempts = 4;
  std::vector<int> kept;
  EmbedResult first = embed_once(request, kept, cache);
  if (!may_keep_faces(first)) return first;
  std::vector<int> turned = first.certificate.nonpositive_faces;
  for (int k = 0; k < attempts; ++k) {
    const bool is_last = k + 1 == attempts;
    kept = is_last ? all_faces(surface.triangles) : with_faces_around(turned, kept, surface);
    EmbedResult next = embed_once(request, kept, cache);
    first.timings.insert(first.timings.end(), next.timings.begin(), next.timings.end());
    if (next.certificate.bijective) {
      next.timings = first.timings;
      return next;
    }
    if (!may_keep_faces(next)) k = std::max(k, attempts - 2);
    turned = next.certificate.nonpositive_faces;
  }
  return first;
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
    EmbedResult result = embed_or_keep_faces(request, cache);
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
