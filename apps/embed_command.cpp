// SPDX-License-Identifier: MIT
#include <fmt/format.h>
#include <fmt/ranges.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <variant>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/embed.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/io/corner_file.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"

namespace orbitutte::cli {
namespace {

class Stopwatch {
 public:
  double seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

long long peak_memory_bytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<long long>(usage.ru_maxrss) * 1024;
}

// One line that is written again and again, on a terminal only.
class ProgressLine {
 public:
  explicit ProgressLine(bool quiet) : shown_(!quiet && isatty(STDERR_FILENO)) {}
  ~ProgressLine() { clear(); }
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  void show(const Progress& progress) const {
    if (!shown_) return;
    if (progress.stage == "optimize" && progress.energy > 0) {
      fmt::print(stderr, "\r\033[Koptimize: iteration {}, energy {:.9g}, gradient {:.1e}", progress.iteration,
                 progress.energy, progress.gradient_norm);
    } else {
      fmt::print(stderr, "\r\033[K{} ...", progress.stage);
    }
    std::fflush(stderr);
  }

  void clear() const {
    if (shown_) fmt::print(stderr, "\r\033[K");
  }

 private:
  bool shown_;
};

Spread parse_spread(const std::string& text) {
  if (text == "arc-length") return Spread::arc_length;
  if (text == "equidistant") return Spread::equidistant;
  throw ArgumentError(fmt::format("--spread is '{}'; it may be arc-length or equidistant", text));
}

// What is asked for: an orbifold, or a polygon with its corners.
Orbifold orbifold_from(const EmbedArguments& arguments) {
  const bool polygon = arguments.orbifold == polygon_signature;
  if (!polygon && !arguments.polygon.empty())
    throw ArgumentError(fmt::format(
        "--polygon gives the corners of a fixed boundary, which {} has not; give --orbifold polygon",
        arguments.orbifold));
  if (!polygon && arguments.cones.empty())
    throw ArgumentError("--cones is missing; mark vertices, or 'auto'");
  if (!polygon) return parse_orbifold(arguments.orbifold);
  if (arguments.polygon.empty())
    throw ArgumentError(
        "--polygon is missing: the file with the corners of the polygon, 'vertex x y z' each");
  if (!arguments.cones.empty())
    throw ArgumentError("--cones is not for polygons: the lines of --polygon name the vertices");
  return polygon_orbifold(read_corners(arguments.polygon));
}

EmbedOptions options_from(const EmbedArguments& arguments) {
  EmbedOptions options;
  options.weights = {parse_weights(arguments.weights), arguments.clamp};
  options.weights_file = arguments.weights_file;
  options.cut.seed = arguments.cut_seed;
  options.spread = parse_spread(arguments.spread);
  options.tolerance = arguments.tolerance;
  options.max_iterations = arguments.max_iterations;
  options.threads = arguments.threads;
  return options;
}

using AnyMesh = std::variant<Mesh, PolygonMesh>;

AnyMesh triangles_or_polygons(PolygonMesh polygons) {
  if (is_triangle_mesh(polygons)) return to_triangle_mesh(std::move(polygons));
  require_embeddable(inspect(polygons));
  return polygons;
}

struct Input {
  AnyMesh mesh;
  std::vector<std::string> warnings;  // of the reader
};

// Reads the mesh, and notes what the report says of its file.
Input read_input(const std::string& path, RunRecord& run) {
  const Stopwatch reading;
  const MeshFormat format = mesh_format(path);
  const std::string bytes = read_file(path);
  run.mesh_path = path;
  run.input_sha256 = sha256(bytes);
  try {
    PolygonMesh mesh = parse_mesh(bytes, format);
    Input input = {{}, std::move(mesh.warnings)};
    input.mesh = triangles_or_polygons(std::move(mesh));
    run.read_seconds = reading.seconds();
    return input;
  } catch (const MeshError& error) {
    throw MeshError(fmt::format("{}: {}", path, error.what()));
  }
}

void summarize(const EmbedArguments& arguments, const EmbedResult& result) {
  const Minimum& minimum = result.minimum;
  std::vector<int> cones;
  for (const ConeCopies& cone : result.embedding.cones) cones.push_back(cone.vertex);
  fmt::print(stderr, "{}: {} vertices, {} faces, a {}, onto {} (group of order {}), cones {}\n",
             arguments.mesh, minimum.positions.rows(), result.embedding.input_faces().count(),
             name(result.topology), result.embedding.signature, result.embedding.group_order,
             fmt::join(cones, ","));
  fmt::print(stderr, "energy {:.12g} after {} iterations, gradient {:.1e}: {}\n", minimum.energy,
             minimum.iterations, minimum.gradient_norm, name(minimum.termination));
  fmt::print(stderr, "area distortion: mean {:.4g}, max {:.4g}; angle distortion: mean {:.4g}, max {:.4g}\n",
             result.distortion.area.mean, result.distortion.area.max, result.distortion.angle.mean,
             result.distortion.angle.max);
  if (result.certificate.bijective) {
    fmt::print(stderr, "certified: bijective\n");
    return;
  }
  fmt::print(stderr, "not certified:\n");
  for (const Check& check : result.certificate.checks)
    if (!check.passed) fmt::print(stderr, "  {}: {}\n", check.name, check.detail);
  if (result.intrinsic_certificate && result.intrinsic_certificate->bijective)
    fmt::print(stderr, "certified of the intrinsic Delaunay triangulation: bijective\n");
}

}  // namespace

int embed_command(const EmbedArguments& arguments) {
  const Stopwatch total;
  EmbedOptions options = options_from(arguments);
  const Orbifold orbifold = orbifold_from(arguments);
  const bool automatic = arguments.cones == "auto";
  std::vector<int> cones = corner_vertices(orbifold);
  if (cones.empty() && !automatic) cones = parse_cones(arguments.cones);

  RunRecord run;
  const auto [mesh, reader_warnings] = read_input(arguments.mesh, run);

  if (automatic) {
    cones = std::visit([&](const auto& known) { return choose_marked_vertices(known, orbifold); }, mesh);
    if (!arguments.quiet) fmt::print(stderr, "--cones {}\n", fmt::join(cones, ","));
  }
  const ProgressLine line(arguments.quiet);
  options.progress = [&](const Progress& progress) {
    line.show(progress);
    return true;
  };
  EmbedResult result =
      std::visit([&](const auto& known) { return embed(known, orbifold, cones, options); }, mesh);
  result.warnings.insert(result.warnings.begin(), reader_warnings.begin(), reader_warnings.end());
  line.clear();
  for (const std::string& warning : result.warnings) fmt::print(stderr, "orbitutte: warning: {}\n", warning);

  const Stopwatch writing;
  if (!arguments.output.empty()) write_file(arguments.output, serialize_embedding(result.embedding));
  run.write_seconds = writing.seconds();
  run.total_seconds = total.seconds();
  run.peak_memory_bytes = peak_memory_bytes();
  const std::string report = report_json(result, run);
  if (!arguments.report.empty()) write_file(arguments.report, report);
  if (arguments.json) fmt::print("{}", report);
  if (!arguments.quiet) summarize(arguments, result);
  if (result.minimum.termination != Termination::converged) return not_converged;
  return result.certificate.bijective ? succeeded : not_certified;
}

}  // namespace orbitutte::cli
