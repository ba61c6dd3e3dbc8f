// SPDX-License-Identifier: MIT
// A map between two surfaces, and its files.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <optional>
#include <system_error>

#include "command_arguments.h"
#include "command_files.h"
#include "commands.h"
#include "orbitutte/export/map_files.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/landmark_file.h"
#include "orbitutte/map/composed_map.h"
#include "orbitutte/map/surface_map.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/map_report.h"
#include "orbitutte/report/report.h"
#include "run.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

namespace fs = std::filesystem;

std::string in_folder(const std::string& folder, const char* name) {
  return (fs::path(folder) / name).string();
}

std::vector<OutputFile> files_in(const std::string& folder) {
  std::vector<OutputFile> files;
  for (const char* const name : {"a.ply", "b.ply", "a.json", "b.json", "map.json", "a_to_b.txt", "b_to_a.txt",
                                 "overlay_a.obj", "overlay_b.obj"})
    files.push_back({"-o", "the map", in_folder(folder, name), {".ply", ".json", ".txt", ".obj"}});
  return files;
}

// No file of the folder may be one that the command reads.
void require_inputs_kept(const MapArguments& arguments) {
  if (arguments.output.empty()) return;
  std::vector<InputFile> inputs = {{"surface A", arguments.a}, {"surface B", arguments.b}};
  if (!arguments.landmarks.empty() && !is_landmark_list(arguments.landmarks))
    inputs.push_back({"the landmarks", arguments.landmarks});
  require_sound_files(inputs, files_in(arguments.output));
}

void make_folder(const std::string& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (fs::is_directory(folder)) return;
  throw FileError(fmt::format("the folder '{}' cannot be made: {}", folder,
                              error ? error.message() : "a file has that name"));
}

std::vector<Landmark> landmarks_from(const std::string& text) {
  if (text.empty()) return {};
  return is_landmark_list(text) ? parse_landmarks(text) : read_landmarks(text);
}

MapOptions options_from(const MapArguments& arguments) {
  MapOptions options;
  options.embed.weights = {parse_choice<WeightKind>(arguments.weights, "--weights"), arguments.clamp};
  options.embed.tolerance = arguments.tolerance;
  options.embed.max_iterations = arguments.max_iterations;
  options.embed.threads = arguments.threads;
  options.cut_a.seed = arguments.cut_seed_a;
  options.cut_b.seed = arguments.cut_seed_b;
  options.tile = parse_choice<TileShape>(arguments.tile, "--tile");
  if (!arguments.tour.empty()) options.tour = parse_cones(arguments.tour);
  return options;
}

// One of the two surfaces on its way to its files.
struct MappedInput {
  Input input;
  RunRecord run;
};

MappedInput read_surface(const std::string& path) {
  MappedInput result;
  result.input = read_input(path, result.run);
  for (const std::string& warning : result.input.warnings)
    tell("orbitutte: warning: {}: {}\n", path, warning);
  return result;
}

// The contents of all files, so that none is written if one cannot be made.
using Contents = std::vector<std::pair<const char*, std::string>>;

void add_embedding(const EmbedResult& result, const RunRecord& run, const std::array<const char*, 2>& names,
                   Contents& contents) {
  contents.emplace_back(names[0], serialize_embedding(result.embedding));
  contents.emplace_back(names[1], report_json(result, run));
}

void write_composed(const std::string& folder, const ComposedMap& composed) {
  write_vertex_map(in_folder(folder, "a_to_b.txt"), composed.a_to_b);
  write_vertex_map(in_folder(folder, "b_to_a.txt"), composed.b_to_a);
  write_overlay(in_folder(folder, "overlay_a.obj"), composed.overlay, composed.overlay_on_a);
  write_overlay(in_folder(folder, "overlay_b.obj"), composed.overlay, composed.overlay_on_b);
}

void tell_warnings(const SurfaceMap& map) {
  for (const std::string& warning : map.warnings) tell("orbitutte: warning: {}\n", warning);
  for (const std::string& warning : map.a.warnings) tell("orbitutte: warning: A: {}\n", warning);
  for (const std::string& warning : map.b.warnings) tell("orbitutte: warning: B: {}\n", warning);
}

double conformality(const EmbedResult& result) {
  return result.minimum.energy / (2 * target_area(result.embedding.target));
}

void summarize(const SurfaceMap& map, const std::optional<ComposedMap>& composed) {
  const Target& target = map.target();
  tell("{} landmarks, onto {} ({}); energy over twice the area {:.4g} and {:.4g}, where 1 is conformal\n",
       map.landmarks.size(), target.signature,
       target.has_free_tile ? fmt::format("a {} tile", name_of(map.map_class.tile)) : "its only tile",
       conformality(map.a), conformality(map.b));
  if (composed) {
    tell("the overlay has {} vertices and {} faces\n", composed->overlay.vertex_count(),
         composed->overlay.face_count());
    tell(
        "symmetric Dirichlet energy: median {:.4g}, where 1 is an isometry; area within a factor of 4 on "
        "{:.1f} %\n",
        composed->distortion.symmetric_dirichlet.median, 100 * composed->distortion.within_4);
  }
  if (is_certified(map, composed)) tell("certified: bijective\n");
}

void explain(char name, const EmbedResult& result) {
  if (result.certificate.bijective) return;
  tell("orbitutte: the embedding of {} is not certified: {} of {} faces are not positive\n", name,
       result.certificate.nonpositive_faces.size(), result.embedding.faces().count());
  for (const Check& check : result.certificate.checks)
    if (!check.passed) tell("  {}: {}\n", check.name, check.detail);
}

// Nothing if an embedding is not certified.
std::optional<ComposedMap> composed_map(const Surface& a, const Surface& b, const SurfaceMap& map) {
  if (!map.is_bijective()) return std::nullopt;
  try {
    return compose(a, b, map);
  } catch (const Error& error) {
    tell("orbitutte: both embeddings are certified, but they cannot be laid over each other: {}\n",
         error.what());
    return std::nullopt;
  }
}

void explain(const OverlayCertificate& certificate) {
  for (const Check& check : certificate.checks)
    if (!check.passed) tell("orbitutte: the overlay does not hold: {}: {}\n", check.name, check.detail);
}

ExitCode exit_code(const SurfaceMap& map, const std::optional<ComposedMap>& composed) {
  if (is_certified(map, composed)) return succeeded;
  const bool converged = map.a.minimum.termination == Termination::converged &&
                         map.b.minimum.termination == Termination::converged;
  return converged ? not_certified : not_converged;
}

}  // namespace

int map_command(const MapArguments& arguments) {
  const Stopwatch total;
  require_inputs_kept(arguments);
  MapOptions options = options_from(arguments);
  const std::vector<Landmark> landmarks = landmarks_from(arguments.landmarks);
  MappedInput a = read_surface(arguments.a), b = read_surface(arguments.b);
  const ProgressLine line(arguments.quiet);
  options.embed.progress = [&](const Progress& progress) {
    line.show(progress);
    return true;
  };
  SurfaceMap map = map_between(*a.input.surface, *b.input.surface, landmarks, options);
  line.clear();
  tell_warnings(map);

  const Stopwatch composing;
  const std::optional<ComposedMap> composed = composed_map(*a.input.surface, *b.input.surface, map);
  Timings timings = map.timings;
  timings.emplace_back("compose", composing.seconds());
  timings.emplace_back("total", total.seconds());
  for (MappedInput* const side : {&a, &b}) {
    side->run.total_seconds = total.seconds();
    side->run.peak_memory_bytes = peak_memory_bytes();
    const Embedding& embedding = (side == &a ? map.a : map.b).embedding;
    side->run.strain = strain_statistics(measure_strain(*side->input.surface, embedding).at_vertices);
  }
  const std::string json = map_json(map, composed, timings);
  if (!arguments.output.empty()) {
    Contents contents;
    add_embedding(map.a, a.run, {"a.ply", "a.json"}, contents);
    add_embedding(map.b, b.run, {"b.ply", "b.json"}, contents);
    contents.emplace_back("map.json", json);
    make_folder(arguments.output);
    for (const auto& [name, bytes] : contents) write_file(in_folder(arguments.output, name), bytes);
    if (composed) write_composed(arguments.output, *composed);
  }
  if (arguments.json) fmt::print("{}", json);
  if (!arguments.quiet) summarize(map, composed);
  explain('A', map.a);
  explain('B', map.b);
  if (composed) explain(composed->certificate);
  return exit_code(map, composed);
}

}  // namespace orbitutte::cli
