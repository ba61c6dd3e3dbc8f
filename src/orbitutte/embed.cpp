// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

#include "orbitutte/cones/extremities.h"
#include "orbitutte/inspect/weak_places.h"
#include "orbitutte/parallel.h"
#include "orbitutte/preparation.h"
#include "orbitutte/solve/flipped_edges.h"
#include "orbitutte/solve/placement.h"
#include "orbitutte/warnings.h"

namespace orbitutte {
namespace {

// What did not converge is not certified.
void refuse(Certificate& certificate, const Minimum& minimum, double tolerance) {
  certificate.bijective = false;
  certificate.checks.push_back(
      {"converged", false, minimum.gradient_norm, tolerance, "the optimiser ended before it converged"});
}

// The gluing problem of the mesh that is cut in `prepared`.
GluingProblem gluing_problem(const EmbedRequest& request, const EdgeWeights& weights,
                             const Preparation& prepared) {
  const Mesh& mesh = request.mesh;
  const CutMesh& cut = prepared.cut;
  const Connectivity& connectivity = prepared.surface->connectivity;
  const auto glued_along = [&](const BoundaryConditions& conditions) {
    return weights.triangulation
               ? flipped_edges(mesh.F, connectivity, *weights.triangulation, cut, conditions)
               : glued_edges(cut, connectivity, conditions);
  };
  LaplacianOptions laplacian = request.options.laplacian;
  laplacian.reuse = prepared.laplacians;
  const Tile tile = basic_tile(request.orbifold, cut.arrangement);  // appendix A
  return {mesh,
          cut,
          request.orbifold,
          weights,
          glued_along,
          laplacian,
          tile,
          boundary_conditions(mesh, cut, tile, request.orbifold, request.options.spread)};
}

// Certificate and distortion of result.embedding.
void judge(const EmbedRequest& request, const FaceView& faces, EmbedResult& result) {
  const Mesh& mesh = request.mesh;
  result.certificate = certify(static_cast<int>(mesh.V.rows()), faces, result.embedding);
  if (!result.certificate.bijective && result.weights.triangulation)
    result.intrinsic_certificate = certify_intrinsic(mesh, result.embedding, *result.weights.triangulation);
  result.distortion = measure_distortion(mesh, result.embedding);
  if (result.minimum.termination == Termination::converged) return;
  refuse(result.certificate, result.minimum, request.options.tolerance);
  if (result.intrinsic_certificate)
    refuse(*result.intrinsic_certificate, result.minimum, request.options.tolerance);
}

void append(const std::vector<std::string>& more, std::vector<std::string>& warnings) {
  warnings.insert(warnings.end(), more.begin(), more.end());
}

// The method, from the mesh to the certificate.
EmbedResult embed_once(const EmbedRequest& request, Preparation& prepared) {
  const auto& [mesh, orbifold, marked_vertices, options] = request;
  if (marked_vertices.size() != orbifold.marks.size())
    throw MeshError(fmt::format("{} needs {} marked vertices, not {}", orbifold.signature,
                                orbifold.marks.size(), marked_vertices.size()));
  EmbedResult result;
  Stages stage(options.progress, result.timings);
  result.threads = thread_count();
  result.backend = options.laplacian.backend;

  stage("validate", [&] { find_surface(request, prepared); });
  stage("weights", [&] { result.weights = find_weights(request, prepared); });  // section 4
  stage("cut", [&] { find_cut(request, result.weights, prepared); });           // section 4.1
  const CutMesh& cut = prepared.cut;

  LbfgsOptions lbfgs;
  lbfgs.tolerance = options.tolerance;
  lbfgs.max_iterations = options.max_iterations;
  Placement placed = place(gluing_problem(request, result.weights, prepared), lbfgs, stage);  // (2)
  result.minimum = std::move(placed.minimum);
  const Tile& tile = placed.tile;
  const BoundaryConditions& boundary = placed.boundary;

  const InputFaces faces(prepared, mesh.F), cut_faces(prepared, cut.F, cut.turned);
  const std::vector<Ear> ears = find_ears(cut_faces.view(), tile, boundary);
  round_outward(ears, result.minimum.positions);
  result.embedding = {orbifold.signature,
                      orbifold.group_order,
                      boundary.spread(result.minimum.positions, cut.source_vertex),
                      cut.F,
                      cut.source_vertex,
                      boundary.seams,
                      boundary.cones,
                      cut_faces.polygons(),
                      orbifold.geometry};
  stage("certify", [&] { judge(request, faces.view(), result); });

  result.warnings = warnings_about(result.weights, ears);
  append(prepared.warnings, result.warnings);
  if (const std::vector<int>& nonpositive = result.certificate.nonpositive_faces; !nonpositive.empty()) {
    const auto mirrors = mirrors_of(tile, boundary, cut.source_vertex);
    const std::vector<int> collapsing = collapsing_faces(faces.view(), mirrors, marked_vertices);
    append(warnings_of_collapse(faces.view(), collapsing, nonpositive), result.warnings);
  }
  result.topology = prepared.surface->topology;
  result.unreferenced_vertices = prepared.surface->unreferenced_vertices;
  result.zero_area_faces = prepared.surface->zero_area_faces;
  return result;
}

// Can it help to keep the faces that the result turns over? Where they are many, it is double precision that
// does not resolve them.
bool may_keep_faces(const EmbedResult& result) {
  const auto turned = static_cast<Eigen::Index>(result.certificate.nonpositive_faces.size());
  return result.weights.triangulation && result.minimum.termination == Termination::converged && turned > 0 &&
         turned <= 1 + result.embedding.faces.rows() / 50;
}

// `kept` with the faces that share a vertex with one of `faces`; ascending.
std::vector<int> with_faces_around(const std::vector<int>& faces, const std::vector<int>& kept,
                                   const Mesh& mesh) {
  std::vector<char> near(mesh.V.rows(), 0), chosen(mesh.F.rows(), 0);
  for (const int f : kept) chosen[f] = 1;
  for (const int f : faces)
    for (const int v : mesh.F.row(f)) near[v] = 1;
  std::vector<int> result;
  for (int f = 0; f < static_cast<int>(mesh.F.rows()); ++f)
    if (chosen[f] || near[mesh.F(f, 0)] || near[mesh.F(f, 1)] || near[mesh.F(f, 2)]) result.push_back(f);
  return result;
}

std::vector<int> all_faces(const Faces& F) {
  std::vector<int> faces(F.rows());
  std::iota(faces.begin(), faces.end(), 0);
  return faces;
}

// The triangulation that has the weights may be embedded while thin triangles of the input, which are not
// among its faces, are turned over. Then those and the faces around them become faces of it, and the map is
// computed again, up to a few times; at last with all faces kept, which leaves the paper's weights but for
// the cones. The first that is certified is the result; where none is, the very first.
EmbedResult embed_or_keep_faces(const EmbedRequest& request, Preparation& prepared) {
  const Mesh& mesh = request.mesh;
  constexpr int attempts = 4;
  EmbedResult first = embed_once(request, prepared);
  if (!may_keep_faces(first)) return first;
  EmbedOptions keeping = request.options;
  const EmbedRequest retry = {mesh, request.orbifold, request.marked_vertices, keeping};
  std::vector<int>& kept = keeping.weights.kept_faces;
  std::vector<int> turned = first.certificate.nonpositive_faces;
  for (int k = 0; k < attempts; ++k) {
    const bool is_last = k + 1 == attempts;
    kept = is_last ? all_faces(mesh.F) : with_faces_around(turned, kept, mesh);
    EmbedResult next = embed_once(retry, prepared);
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

std::vector<int> far_from_each_other(const Mesh& mesh, const SoundSurface& surface,
                                     const Orbifold& orbifold) {
  require_topology(mesh, surface, orbifold);
  const int outer = static_cast<int>(orbifold.marks.size()) - orbifold.inner_marks;
  return extremities(mesh, surface.connectivity, {orbifold.inner_marks, outer, are_opposite(orbifold.marks)});
}

EmbedResult embed_prepared(const Mesh& mesh, Preparation& prepared, const Orbifold& orbifold,
                           const std::vector<int>& marked_vertices, const EmbedOptions& options) {
  if (options.threads < 0) throw ArgumentError("the number of threads must not be negative");
  EmbedOptions chosen = options;
  if (chosen.weights.kind == WeightKind::standard)
    chosen.weights.kind = prepared.polygons ? WeightKind::cotan : WeightKind::delaunay;
  return with_threads(options.threads, [&] {
    return embed_or_keep_faces({mesh, orbifold, marked_vertices, chosen}, prepared);
  });
}

}  // namespace

EmbedResult embed(const Mesh& mesh, const Orbifold& orbifold, const std::vector<int>& marked_vertices,
                  const EmbedOptions& options) {
  Preparation prepared;
  return embed_prepared(mesh, prepared, orbifold, marked_vertices, options);
}

EmbedResult embed(const PolygonMesh& mesh, const Orbifold& orbifold, const std::vector<int>& marked_vertices,
                  const EmbedOptions& options) {
  if (is_triangle_mesh(mesh)) return embed(to_triangle_mesh(mesh), orbifold, marked_vertices, options);
  Preparation prepared;
  const Mesh triangles = prepare(mesh, options, prepared);
  return embed_prepared(triangles, prepared, orbifold, marked_vertices, options);
}

struct EmbeddingSolver::State {
  Mesh mesh;
  EmbedOptions options;
  Preparation prepared;
};

EmbeddingSolver::EmbeddingSolver(Mesh mesh, EmbedOptions options)
    : state_(std::make_unique<State>(State{std::move(mesh), std::move(options), {}})) {
  state_->prepared.laplacians = reusable_laplacians(Kept::factors);
}

EmbeddingSolver::EmbeddingSolver(const PolygonMesh& mesh, EmbedOptions options)
    : EmbeddingSolver(Mesh(), std::move(options)) {
  if (is_triangle_mesh(mesh)) {
    state_->mesh = to_triangle_mesh(mesh);
    return;
  }
  state_->mesh = prepare(mesh, state_->options, state_->prepared);
}

EmbeddingSolver::~EmbeddingSolver() = default;
EmbeddingSolver::EmbeddingSolver(EmbeddingSolver&&) noexcept = default;

EmbedResult EmbeddingSolver::embed(const Orbifold& orbifold, const std::vector<int>& marked_vertices) {
  return embed_prepared(state_->mesh, state_->prepared, orbifold, marked_vertices, state_->options);
}

std::vector<int> choose_marked_vertices(const Mesh& mesh, const Orbifold& orbifold) {
  return far_from_each_other(mesh, require_surface(mesh), orbifold);
}

std::vector<int> choose_marked_vertices(const PolygonMesh& mesh, const Orbifold& orbifold) {
  if (is_triangle_mesh(mesh)) return choose_marked_vertices(to_triangle_mesh(mesh), orbifold);
  const DividedMesh divided = divide(mesh);
  return far_from_each_other(divided.triangles, divided.surface, orbifold);
}

}  // namespace orbitutte
