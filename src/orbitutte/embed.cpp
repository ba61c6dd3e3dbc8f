// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <fmt/format.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <chrono>
#include <cmath>

#include "orbitutte/mesh/extremities.h"
#include "orbitutte/mesh/inspection.h"
#include "orbitutte/solve/ears.h"
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

// The number of OpenMP threads while it lives.
class ThreadCount {
 public:
  explicit ThreadCount(int threads) : before_(omp_get_max_threads()) {
    if (threads > 0) omp_set_num_threads(threads);
  }
  ~ThreadCount() { omp_set_num_threads(before_); }
  ThreadCount(const ThreadCount&) = delete;
  ThreadCount& operator=(const ThreadCount&) = delete;

 private:
  int before_;
};

void require_topology(const Inspection& inspection, const Orbifold& orbifold) {
  require_embeddable(inspection);
  if (inspection.topology == orbifold.topology) return;
  throw MeshError(
      fmt::format("the mesh is a {}, but {} needs a {}; choose an orbifold for it (see 'orbitutte types')",
                  name(inspection.topology), orbifold.signature, name(orbifold.topology)));
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

}  // namespace

EmbedResult embed(const Mesh& mesh, const Orbifold& orbifold, const std::vector<int>& marked_vertices,
                  const EmbedOptions& options) {
  if (options.threads < 0) throw ArgumentError("the number of threads must not be negative");
  if (marked_vertices.size() != orbifold.marks.size())
    throw MeshError(fmt::format("{} needs {} marked vertices, not {}", orbifold.signature,
                                orbifold.marks.size(), marked_vertices.size()));
  EmbedResult result;
  Stages stage(options.progress, result.timings);
  const ThreadCount threads(options.threads);
  result.threads = omp_get_max_threads();
  result.backend = options.laplacian.backend;

  const Inspection inspection = stage("validate", [&] { return inspect(mesh); });
  require_topology(inspection, orbifold);
  result.topology = inspection.topology;
  result.unreferenced_vertices = inspection.unreferenced_vertices;
  result.zero_area_faces = inspection.zero_area_faces;

  const Connectivity connectivity = connect(mesh.F, static_cast<int>(mesh.V.rows()));
  result.weights = stage("weights", [&] {  // section 4
    return options.weights_file.empty() ? edge_weights(mesh, connectivity, options.weights)
                                        : read_weights(options.weights_file, connectivity);
  });

  const CutMesh cut =
      stage("cut", [&] { return cut_to_disk(mesh, connectivity, marked_vertices, options.cut); });  // 4.1
  Tile tile = basic_tile(orbifold, cut.arrangement);                         // appendix A
  BoundaryConditions boundary = glue(cut, tile, orbifold, marked_vertices);  // (3), (4), (7)
  const GluedEdges glued = glued_edges(cut, connectivity, boundary);
  require_apart(glued, boundary, orbifold);
  const SphericalEnergy energy(glued, result.weights, boundary);  // (2)
  const LaplacianSolver laplacian = stage(
      "factorize", [&] { return LaplacianSolver(cut, glued, result.weights, boundary, options.laplacian); });
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
    boundary = glue(cut, tile, orbifold, marked_vertices);
    const SphericalEnergy there(glued_edges(cut, connectivity, boundary), result.weights, boundary);
    positions = settle_in_frame(positions, *frame, there, boundary);
  }
  const std::vector<Ear> ears = find_ears(cut, tile, boundary);
  result.warnings = warnings_about(result.weights, ears);
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
    result.distortion = measure_distortion(mesh, result.embedding);
  });
  if (result.minimum.termination != Termination::converged) {
    result.certificate.bijective = false;
    result.certificate.checks.push_back({"converged", false, result.minimum.gradient_norm, options.tolerance,
                                         "the optimiser ended before it converged"});
  }
  return result;
}

std::vector<int> choose_marked_vertices(const Mesh& mesh, const Orbifold& orbifold) {
  require_topology(inspect(mesh), orbifold);
  return extremities(mesh, connect(mesh.F, static_cast<int>(mesh.V.rows())),
                     static_cast<int>(orbifold.marks.size()));
}

}  // namespace orbitutte
