// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "orbitutte/mesh/cone_weights.h"
#include "orbitutte/mesh/extremities.h"
#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/recognition.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/ears.h"
#include "orbitutte/solve/flipped_edges.h"
#include "orbitutte/solve/frame.h"
#include "orbitutte/solve/initial_embedding.h"

namespace orbitutte {
namespace {

// Runs the stages, tells of each and times it.
class Stages {
 public:
  Stages(const ProgressCallback& progress, Timings& timings) : progress_(progress), timings_(timings) {}

  template <typename Step>
  auto operator()(const char* stage, const Step& step) {
    tell({stage});
    const Clock clock(stage, timings_);
    return step();
  }

  void tell(const Progress& progress) const {
    if (progress_ && !progress_(progress)) throw Cancelled();
  }

 private:
  class Clock {
   public:
    Clock(const char* stage, Timings& timings) : stage_(stage), timings_(timings) {}
    ~Clock() {
      const std::chrono::duration<double> passed = std::chrono::steady_clock::now() - start_;
      timings_.emplace_back(stage_, passed.count());
    }

   private:
    const char* stage_;
    Timings& timings_;
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
  };

  const ProgressCallback& progress_;
  Timings& timings_;
};

void require_topology(Topology topology, const Orbifold& orbifold) {
  if (topology == orbifold.topology) return;
  throw MeshError(
      fmt::format("the mesh is a {}, but {} needs a {}; choose an orbifold for it (see 'orbitutte types')",
                  name(topology), orbifold.signature, name(orbifold.topology)));
}

// The mesh as a sphere or disk.
SoundSurface require_surface(const Mesh& mesh) {
  if (std::optional<SoundSurface> surface = recognize(mesh)) return std::move(*surface);
  const Inspection inspection = inspect(mesh);
  require_embeddable(inspection);
  if (inspection.topology == Topology::projective_plane)
    throw MeshError(
        "the mesh is a projective-plane; no orbifold of this version takes one (see 'orbitutte types')");
  throw std::logic_error("a mesh without defects was not recognised");
}

// Cones that lie opposite to each other need more than one edge between them: every arc of length pi is as
// short as any other.
void require_apart(const GluedEdges& glued, const BoundaryConditions& boundary, const Orbifold& orbifold) {
  for (const auto& [i, j, t] : glued.edges) {
    if (boundary.basis(i).cols() > 0 || boundary.basis(j).cols() > 0) continue;
    const Vector3 p = boundary.held.row(i), q = glued.transforms[t] * boundary.held.row(j).transpose();
    if ((p + q).norm() < 1e-9)
      throw MeshError(
          fmt::format("the marked vertices {} and {} are joined by an edge, but {} puts them at opposite "
                      "points of the sphere; mark "
                      "vertices that are further apart, or split the edge",
                      i, j, orbifold.signature));
  }
}

// Where a rotation about the axis changes nothing, turns the map so that the vertex nearest to the equator
// has longitude 0.
void fix_gauge(const Tile& tile, Points& positions) {
  Vector3 axis;
  if (!free_rotation_axis(tile, axis)) return;
  Eigen::Index vertex = 0;
  (positions * axis).cwiseAbs().minCoeff(&vertex);
  const Vector3 forward = tile.sides.front().direction, left = axis.cross(forward);
  const Vector3 p = positions.row(vertex);
  const double longitude = std::atan2(p.dot(left), p.dot(forward));
  positions = positions * Eigen::AngleAxisd(-longitude, axis).toRotationMatrix().transpose();
  positions.rowwise().normalize();
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

std::vector<std::string> warnings_about(const EdgeWeights& weights, const std::vector<Ear>& ears) {
  std::vector<std::string> warnings;
  if (weights.zero_edges > 0)
    warnings.push_back(fmt::format("{} edges have the weight zero; the theory asks for positive weights",
                                   weights.zero_edges));
  if (!ears.empty())
    warnings.push_back(
        fmt::format("{} triangles have two edges on one mirror and become arcs, the first face {}: their "
                    "areas are rounding errors; "
                    "swap their inner edges, or mark their tips",
                    ears.size(), ears.front().face));
  return warnings;
}

// What did not converge is not certified.
void refuse(Certificate& certificate, const Minimum& minimum, const EmbedOptions& options) {
  certificate.bijective = false;
  certificate.checks.push_back({"converged", false, minimum.gradient_norm, options.tolerance,
                                "the optimiser ended before it converged"});
}

// What is known of a mesh before its cones are, and its last cut.
struct Preparation {
  std::optional<SoundSurface> surface;
  std::optional<EdgeWeights> weights;
  std::vector<int> kept_faces;  // with which these were computed
  std::optional<std::pair<std::vector<int>, int>>
      cut_through;  // the marked vertices of `cut`, and how many lie inside
  CutMesh cut;
  std::shared_ptr<LaplacianReuse> laplacians = reusable_laplacians(Kept::order);
};

EmbedResult embed_here(const Mesh& mesh, Preparation& prepared, const Orbifold& orbifold,
                       const std::vector<int>& marked_vertices, const EmbedOptions& options) {
  if (marked_vertices.size() != orbifold.marks.size())
    throw MeshError(fmt::format("{} needs {} marked vertices, not {}", orbifold.signature,
                                orbifold.marks.size(), marked_vertices.size()));
  EmbedResult result;
  Stages stage(options.progress, result.timings);
  result.threads = thread_count();
  result.backend = options.laplacian.backend;

  stage("validate", [&] {
    if (!prepared.surface) prepared.surface = require_surface(mesh);
    require_topology(prepared.surface->topology, orbifold);
  });
  const Connectivity& connectivity = prepared.surface->connectivity;
  stage("weights", [&] {  // section 4
    if (!prepared.weights || prepared.kept_faces != options.weights.kept_faces)
      prepared.weights = options.weights_file.empty() ? edge_weights(mesh, connectivity, options.weights)
                                                      : read_weights(options.weights_file, connectivity);
    prepared.kept_faces = options.weights.kept_faces;
    result.weights = sharpened_at_cones(*prepared.weights, cone_angles(orbifold, marked_vertices));
  });
  const EdgeWeights& weights = result.weights;
  stage("cut", [&] {  // section 4.1; the elimination order is found at the same time
    const std::pair through(marked_vertices, orbifold.inner_marks);
    const bool is_cut = prepared.cut_through == through;
    prepared.cut_through.reset();
    parallel_for(2, [&](int task) {
      if (task == 0 && !is_cut)
        prepared.cut = cut_to_disk(mesh, connectivity, marked_vertices, orbifold.inner_marks, options.cut);
      if (task == 1)
        order_ahead(*prepared.laplacians, weighted_edges(weights, connectivity),
                    static_cast<int>(mesh.V.rows()));
    });
    prepared.cut_through = through;
  });
  const CutMesh& cut = prepared.cut;
  Tile tile = basic_tile(orbifold, cut.arrangement);        // appendix A
  BoundaryConditions boundary = glue(cut, tile, orbifold);  // (3), (4), (7)
  const auto glued_along = [&](const BoundaryConditions& conditions) {
    return weights.triangulation
               ? flipped_edges(mesh.F, connectivity, *weights.triangulation, cut, conditions)
               : glued_edges(cut, connectivity, conditions);
  };
  const GluedEdges glued = glued_along(boundary);
  require_apart(glued, boundary, orbifold);
  const SphericalEnergy energy(glued, weights, boundary);  // (2)
  LaplacianOptions laplacian_options = options.laplacian;
  laplacian_options.reuse = prepared.laplacians;
  const LaplacianSolver laplacian =
      stage("factorize", [&] { return LaplacianSolver(cut, glued, weights, boundary, laplacian_options); });
  const Points start =
      stage("initialize", [&] { return initial_embedding(mesh, cut, tile, boundary, laplacian); });  // B

  LbfgsOptions lbfgs;
  lbfgs.tolerance = options.tolerance;
  lbfgs.max_iterations = options.max_iterations;
  lbfgs.callback = [&](int iteration, const Iteration& state) {
    stage.tell({"optimize", iteration, state.energy, state.gradient_norm});
    return true;
  };
  result.minimum =
      stage("optimize", [&] { return minimize(energy, laplacian, start, lbfgs); });  // algorithm 1
  Points& positions = result.minimum.positions;
  fix_gauge(tile, positions);
  if (const std::optional<Matrix3> frame = resolving_frame(energy, positions)) {
    tile = rotated(tile, *frame);
    boundary = glue(cut, tile, orbifold);
    const SphericalEnergy there(glued_along(boundary), weights, boundary);
    positions = settle_in_frame(positions, *frame, there, boundary);
  }
  const std::vector<Ear> ears = find_ears(cut, tile, boundary);
  result.warnings = warnings_about(weights, ears);
  round_outward(ears, positions);

  result.embedding = {orbifold.signature,
                      orbifold.group_order,
                      boundary.spread(positions, cut.source_vertex),
                      cut.F,
                      cut.source_vertex,
                      boundary.seams,
                      boundary.cones};
  stage("certify", [&] {
    result.certificate = certify(mesh, result.embedding);
    if (!result.certificate.bijective && weights.triangulation)
      result.intrinsic_certificate = certify_intrinsic(mesh, result.embedding, *weights.triangulation);
    result.distortion = measure_distortion(mesh, result.embedding);
  });
  if (result.minimum.termination != Termination::converged) {
    refuse(result.certificate, result.minimum, options);
    if (result.intrinsic_certificate) refuse(*result.intrinsic_certificate, result.minimum, options);
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
EmbedResult embed_or_keep_faces(const Mesh& mesh, Preparation& prepared, const Orbifold& orbifold,
                                const std::vector<int>& marked_vertices, const EmbedOptions& options) {
  constexpr int attempts = 4;
  EmbedResult first = embed_here(mesh, prepared, orbifold, marked_vertices, options);
  if (!may_keep_faces(first)) return first;
  EmbedOptions keeping = options;
  std::vector<int>& kept = keeping.weights.kept_faces;
  std::vector<int> turned = first.certificate.nonpositive_faces;
  for (int k = 0; k < attempts; ++k) {
    const bool is_last = k + 1 == attempts;
    kept = is_last ? all_faces(mesh.F) : with_faces_around(turned, kept, mesh);
    EmbedResult next = embed_here(mesh, prepared, orbifold, marked_vertices, keeping);
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

EmbedResult embed_prepared(const Mesh& mesh, Preparation& prepared, const Orbifold& orbifold,
                           const std::vector<int>& marked_vertices, const EmbedOptions& options) {
  if (options.threads < 0) throw ArgumentError("the number of threads must not be negative");
  return with_threads(options.threads, [&] {
    return embed_or_keep_faces(mesh, prepared, orbifold, marked_vertices, options);
  });
}

}  // namespace

EmbedResult embed(const Mesh& mesh, const Orbifold& orbifold, const std::vector<int>& marked_vertices,
                  const EmbedOptions& options) {
  Preparation prepared;
  return embed_prepared(mesh, prepared, orbifold, marked_vertices, options);
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
EmbeddingSolver::~EmbeddingSolver() = default;
EmbeddingSolver::EmbeddingSolver(EmbeddingSolver&&) noexcept = default;

EmbedResult EmbeddingSolver::embed(const Orbifold& orbifold, const std::vector<int>& marked_vertices) {
  return embed_prepared(state_->mesh, state_->prepared, orbifold, marked_vertices, state_->options);
}

std::vector<int> choose_marked_vertices(const Mesh& mesh, const Orbifold& orbifold) {
  const SoundSurface surface = require_surface(mesh);
  require_topology(surface.topology, orbifold);
  return extremities(mesh, surface.connectivity, orbifold.inner_marks,
                     static_cast<int>(orbifold.marks.size()) - orbifold.inner_marks);
}

}  // namespace orbitutte
