// SPDX-License-Identifier: MIT
#include "orbitutte/embed.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <numeric>
#include <stdexcept>
#include <unordered_set>

#include "orbitutte/mesh/cone_weights.h"
#include "orbitutte/mesh/extremities.h"
#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/recognition.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/mesh/weak_places.h"
#include "orbitutte/parallel.h"
#include "orbitutte/solve/ears.h"
#include "orbitutte/solve/flipped_edges.h"
#include "orbitutte/solve/frame.h"
#include "orbitutte/solve/initial_embedding.h"
#include "orbitutte/solve/planar_minimum.h"

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

// The mesh as a sphere, disk or projective plane.
SoundSurface require_surface(const Mesh& mesh) {
  if (std::optional<SoundSurface> surface = recognize(mesh)) return std::move(*surface);
  const Inspection inspection = inspect(mesh);
  require_embeddable(inspection);
  if (inspection.topology != Topology::projective_plane)
    throw std::logic_error("a mesh without defects was not recognised");
  return {inspection.topology, connect(mesh.F, inspection.vertices), inspection.unreferenced_vertices,
          inspection.zero_area_faces};
}

// Polygons as triangles, and how these make up the polygons.
struct DividedMesh {
  Mesh triangles;
  Triangulation triangulation;
  SoundSurface surface;
};

DividedMesh divide(const PolygonMesh& mesh) {
  const Inspection inspection = inspect(mesh);
  require_embeddable(inspection);
  DividedMesh result;
  result.triangulation = triangulate(mesh);
  result.triangles = {mesh.V, on_vertices(result.triangulation, mesh.corners)};
  result.surface = {inspection.topology, connect(mesh, result.triangulation),
                    inspection.unreferenced_vertices, inspection.zero_area_faces};
  return result;
}

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
    warnings.push_back(fmt::format(
        "{} faces have all edges but one on one mirror or held side and must become arcs, the first face {}: "
        "their areas are rounding errors; swap their inner edges, or mark their tips",
        count_faces(ears), ears.front().face));
  return warnings;
}

// Equations (3), (4) and (7), and the sides that theorem 1 holds.
BoundaryConditions boundary_conditions(const Mesh& mesh, const CutMesh& cut, const Tile& tile,
                                       const Orbifold& orbifold, Spread spread) {
  BoundaryConditions boundary = glue(cut, tile, orbifold);
  hold_sides(mesh, cut, tile, spread, boundary);
  return boundary;
}

// What did not converge is not certified.
void refuse(Certificate& certificate, const Minimum& minimum, const EmbedOptions& options) {
  certificate.bijective = false;
  certificate.checks.push_back({"converged", false, minimum.gradient_norm, options.tolerance,
                                "the optimiser ended before it converged"});
}

// What is known of a mesh before its cones are, and its last cut.
struct Preparation {
  std::optional<Triangulation> polygons;  // that the triangles make up; none where all faces are triangles
  std::vector<std::string> warnings;      // about the polygons
  std::optional<SoundSurface> surface;
  std::optional<EdgeWeights> weights;
  std::vector<int> kept_faces;  // with which these were computed
  std::optional<std::pair<std::vector<int>, int>>
      cut_through;  // the marked vertices of `cut`, and how many lie inside
  CutMesh cut;
  std::shared_ptr<LaplacianReuse> laplacians = reusable_laplacians(Kept::order);
};

// The triangles that stand for polygons; what is known of the polygons goes into `prepared`.
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

// Faces on vertices of the mesh or of its cut: the triangles, or the polygons that they make up.
class InputFaces {
 public:
  InputFaces(const Preparation& prepared, const Faces& triangles, const std::vector<char>& turned = {})
      : polygons_(prepared.polygons ? prepared.polygons->polygons(triangles, turned) : Polygons()),
        view_(prepared.polygons ? FaceView(polygons_) : FaceView(triangles)) {}
  InputFaces(const InputFaces&) = delete;
  InputFaces& operator=(const InputFaces&) = delete;

  const Polygons& polygons() const { return polygons_; }
  const FaceView& view() const { return view_; }

 private:
  Polygons polygons_;
  FaceView view_;
};

// The input vertices of each mirror and held side, along the boundary.
std::vector<std::vector<int>> mirrors_of(const Tile& tile, const BoundaryConditions& boundary,
                                         const std::vector<int>& source_vertex) {
  std::vector<std::vector<int>> mirrors;
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    if (!tile.sides[s].held() && tile.sides[s].partner != static_cast<int>(s)) continue;
    std::vector<int>& mirror = mirrors.emplace_back();
    for (const int v : boundary.sides[s]) mirror.push_back(source_vertex[v]);
  }
  return mirrors;
}

// How many of the faces are among the collapsing ones, or share an edge with one of them at the least.
long count_in_or_beside(const std::vector<int>& collapsing, const FaceView& faces,
                        const std::vector<int>& among) {
  std::unordered_set<int> vertices;
  for (const int f : collapsing) vertices.insert(faces[f].begin(), faces[f].end());
  return std::count_if(among.begin(), among.end(), [&](int f) {
    return std::count_if(faces[f].begin(), faces[f].end(), [&](int v) { return vertices.count(v) > 0; }) > 1;
  });
}

// About faces that are not positively oriented, those of them that no solver could have done better.
void warn_of_collapse(const FaceView& faces, const std::vector<int>& collapsing, EmbedResult& result) {
  const std::vector<int>& nonpositive = result.certificate.nonpositive_faces;
  const long unavoidable = count_in_or_beside(collapsing, faces, nonpositive);
  if (unavoidable == 0) return;
  result.warnings.push_back(
      fmt::format("{} of the {} faces that are not positively oriented must become arcs, or lie beside such "
                  "faces, the first "
                  "face {}: the mesh is not 3-connected there, and no failure of the solver (see 'orbitutte "
                  "info'); mark a "
                  "vertex there, or give it further edges",
                  unavoidable, nonpositive.size(), collapsing.front()));
}

// What has a minimiser: the mesh cut open, and a tile that its boundary is glued to.
struct Problem {
  const Mesh& mesh;
  const CutMesh& cut;
  const Orbifold& orbifold;
  const EdgeWeights& weights;
  std::function<GluedEdges(const BoundaryConditions&)> glued_along;
  LaplacianOptions laplacian;
  Tile tile;
  BoundaryConditions boundary;
};

// The minimiser, and the tile and gluing in the frame where it lies.
struct Placement {
  Minimum minimum;
  Tile tile;
  BoundaryConditions boundary;
};

LaplacianOptions with_reuse(const EmbedOptions& options, const Preparation& prepared) {
  LaplacianOptions laplacian = options.laplacian;
  laplacian.reuse = prepared.laplacians;
  return laplacian;
}

// Turns the map where the tile is free to turn: to where small spots are resolved.
void resolve(const Problem& problem, const SphericalEnergy& energy, Placement& placed) {
  Points& positions = placed.minimum.positions;
  const std::optional<Matrix3> frame =
      stays_put(placed.tile) ? std::nullopt : resolving_frame(energy, positions);
  if (!frame) return;
  placed.tile = rotated(placed.tile, *frame);
  placed.boundary = glue(problem.cut, placed.tile, problem.orbifold);
  const SphericalEnergy there(problem.glued_along(placed.boundary), problem.weights, placed.boundary);
  positions = settle_in_frame(positions, *frame, there, placed.boundary);
}

Placement minimum_on_sphere(const Problem& problem, const EmbedOptions& options, Stages& stage) {
  const GluedEdges glued = problem.glued_along(problem.boundary);
  require_apart(glued, problem.boundary, problem.orbifold);
  const SphericalEnergy energy(glued, problem.weights, problem.boundary);  // (2)
  const LaplacianSolver laplacian = stage("factorize", [&] {
    return LaplacianSolver(problem.cut, glued, problem.weights, problem.boundary, problem.laplacian);
  });
  const Points start = stage("initialize", [&] {  // appendix B
    return initial_embedding(problem.mesh, problem.cut, problem.tile, problem.boundary, laplacian);
  });
  LbfgsOptions lbfgs;
  lbfgs.tolerance = options.tolerance;
  lbfgs.max_iterations = options.max_iterations;
  lbfgs.callback = [&](int iteration, const Iteration& state) {
    stage.tell({"optimize", iteration, state.energy, state.gradient_norm});
    return true;
  };
  Placement placed = {{}, problem.tile, problem.boundary};
  placed.minimum =
      stage("optimize", [&] { return minimize(energy, laplacian, start, lbfgs); });  // algorithm 1
  fix_gauge(placed.tile, placed.minimum.positions);
  resolve(problem, energy, placed);
  return placed;
}

Placement minimum_in_plane(const Problem& problem, const EmbedOptions&, Stages& stage) {
  const GluedEdges glued = problem.glued_along(problem.boundary);
  Placement placed = {{}, problem.tile, problem.boundary};
  stage("optimize", [&] {
    PlanarMinimum solution =
        planar_minimum(problem.cut, glued, problem.weights, problem.boundary, problem.laplacian);
    placed.minimum.positions = std::move(solution.positions);
    placed.minimum.energy = solution.energy;
    placed.minimum.gradient_norm = solution.gradient_norm;
    placed.minimum.iterations = placed.minimum.evaluations = 1;
    placed.minimum.termination = Termination::converged;  // a linear system has been solved
    placed.minimum.history = {{solution.energy, solution.gradient_norm, 0}};
  });
  return placed;
}

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
  const auto glued_along = [&](const BoundaryConditions& conditions) {
    return weights.triangulation
               ? flipped_edges(mesh.F, connectivity, *weights.triangulation, cut, conditions)
               : glued_edges(cut, connectivity, conditions);
  };
  Tile tile = basic_tile(orbifold, cut.arrangement);  // appendix A
  BoundaryConditions boundary = boundary_conditions(mesh, cut, tile, orbifold, options.spread);
  const Problem problem = {mesh, cut,     orbifold, weights, glued_along, with_reuse(options, prepared),
                           tile, boundary};
  Placement placed = tile.geometry() == Geometry::spherical ? minimum_on_sphere(problem, options, stage)
                                                            : minimum_in_plane(problem, options, stage);
  result.minimum = std::move(placed.minimum);
  tile = std::move(placed.tile);
  boundary = std::move(placed.boundary);
  Points& positions = result.minimum.positions;
  const InputFaces faces(prepared, mesh.F), cut_faces(prepared, cut.F, cut.turned);
  const std::vector<Ear> ears = find_ears(cut_faces.view(), tile, boundary);
  result.warnings = warnings_about(weights, ears);
  result.warnings.insert(result.warnings.end(), prepared.warnings.begin(), prepared.warnings.end());
  round_outward(ears, positions);

  result.embedding = {orbifold.signature,
                      orbifold.group_order,
                      boundary.spread(positions, cut.source_vertex),
                      cut.F,
                      cut.source_vertex,
                      boundary.seams,
                      boundary.cones,
                      cut_faces.polygons(),
                      orbifold.geometry};
  stage("certify", [&] {
    result.certificate = certify(static_cast<int>(mesh.V.rows()), faces.view(), result.embedding);
    if (!result.certificate.bijective && weights.triangulation)
      result.intrinsic_certificate = certify_intrinsic(mesh, result.embedding, *weights.triangulation);
    result.distortion = measure_distortion(mesh, result.embedding);
  });
  if (!result.certificate.nonpositive_faces.empty())
    warn_of_collapse(
        faces.view(),
        collapsing_faces(faces.view(), mirrors_of(tile, boundary, cut.source_vertex), marked_vertices),
        result);
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

std::vector<int> far_from_each_other(const Mesh& mesh, const SoundSurface& surface,
                                     const Orbifold& orbifold) {
  require_topology(surface.topology, orbifold);
  return extremities(mesh, surface.connectivity, orbifold.inner_marks,
                     static_cast<int>(orbifold.marks.size()) - orbifold.inner_marks);
}

EmbedResult embed_prepared(const Mesh& mesh, Preparation& prepared, const Orbifold& orbifold,
                           const std::vector<int>& marked_vertices, const EmbedOptions& options) {
  if (options.threads < 0) throw ArgumentError("the number of threads must not be negative");
  EmbedOptions chosen = options;
  if (chosen.weights.kind == WeightKind::standard)
    chosen.weights.kind = prepared.polygons ? WeightKind::cotan : WeightKind::delaunay;
  return with_threads(options.threads,
                      [&] { return embed_or_keep_faces(mesh, prepared, orbifold, marked_vertices, chosen); });
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
