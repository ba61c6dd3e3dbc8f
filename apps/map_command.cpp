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
#include "map_products.h"
#include "orbitutte/export/map_files.h"
#include "orbitutte/export/stored_map.h"
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

// Where the files of the map are, or are written.
std::string folder_of(const MapArguments& arguments) {
  return arguments.output.empty() ? arguments.from : arguments.output;
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
  const std::string folder = folder_of(arguments);
  std::vector<InputFile> inputs = inputs_of_products(arguments);
  inputs.push_back({"surface A", arguments.a});
  inputs.push_back({"surface B", arguments.b});
  if (!arguments.landmarks.empty() && !is_landmark_list(arguments.landmarks))
    inputs.push_back({"the landmarks", arguments.landmarks});
  std::vector<OutputFile> outputs = files_of_products(arguments, folder);
  if (arguments.from.empty() && !folder.empty())
    for (OutputFile& file : files_in(folder)) outputs.push_back(std::move(file));
  if (!arguments.from.empty())
    for (const OutputFile& file : files_in(arguments.from))
      inputs.push_back({"a file of the map", file.path});
  require_sound_files(inputs, outputs);
  require_no_file_there(folder);
  require_folders(outputs, folder);
}

// With --from, what would change the map is not looked at, so it may not be given.
void require_sound_source(const MapArguments& arguments) {
  if (arguments.from.empty()) return;
  if (!arguments.landmarks.empty())
    throw ArgumentError("--landmarks seeks a map and --from reads one; give one of them");
  if (!wants_products(arguments))
    throw ArgumentError("--from reads a map, but nothing is to be made of it; add --picture, --page, ...");
}

std::vector<Landmark> landmarks_from(const std::string& text) {
  if (text.empty()) return {};
  const bool is_list = is_landmark_list(text);
  std::vector<Landmark> landmarks = is_list ? parse_landmarks(text) : read_landmarks(text);
  if (landmarks.empty())
    throw MeshError(fmt::format("{}: there is no landmark in it; leave out --landmarks for a guess",
                                is_list ? "--landmarks" : text));
  return landmarks;
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

// The format is that of the one that comes from standard input.
MeshInput surface_input(const std::string& path, const MapArguments& arguments) {
  if (arguments.a == "-" && arguments.b == "-")
    throw ArgumentError(
        "both surfaces come from standard input, which can be read once; give one of them a file");
  return mesh_input(path, path == "-" ? arguments.format : "");
}

MappedInput read_surface(const MeshInput& input) {
  MappedInput result;
  result.input = read_input(input, result.run);
  for (const std::string& warning : result.input.warnings)
    tell("orbitutte: warning: {}: {}\n", input.path, warning);
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

// The map, and what follows from it; nothing if an embedding is not certified.
struct Mapped {
  SurfaceMap map;
  std::optional<ComposedMap> composed;
};

Mapped mapped(const Surface& a, const Surface& b, SurfaceMap map) {
  std::optional<ComposedMap> composed = composed_map(a, b, map);
  return {std::move(map), std::move(composed)};
}

SurfaceMap sought_map(const MapArguments& arguments, const Surface& a, const Surface& b) {
  MapOptions options = options_from(arguments);
  const std::vector<Landmark> landmarks = landmarks_from(arguments.landmarks);
  const ProgressLine line(arguments.quiet);
  options.embed.progress = [&](const Progress& progress) {
    line.show(progress);
    return true;
  };
  SurfaceMap map = map_between(a, b, landmarks, options);
  line.clear();
  tell_warnings(map);
  return map;
}

SurfaceMap stored_map(const MapArguments& arguments, const Surface& a, const Surface& b) {
  SurfaceMap map = read_surface_map(arguments.from, a, b);
  map.a.threads = map.b.threads = arguments.threads;
  return map;
}

// The files of a map that was sought.
void write_map(const std::string& folder, const Mapped& result, const std::array<RunRecord, 2>& runs,
               const std::string& json) {
  Contents contents;
  add_embedding(result.map.a, runs[0], {"a.ply", "a.json"}, contents);
  add_embedding(result.map.b, runs[1], {"b.ply", "b.json"}, contents);
  make_folder(folder);
  for (const auto& [name, bytes] : contents) write_file(in_folder(folder, name), bytes);
  if (result.composed) write_composed(folder, *result.composed);
  write_file(in_folder(folder, "map.json"), json);  // last: a folder that has it is whole
}

void write_all_products(const MapArguments& arguments, const CarriedInputs& carried, const Mapped& result,
                        const std::array<const Surface*, 2>& surfaces) {
  if (!wants_products(arguments)) return;
  if (!result.composed) {
    tell("orbitutte: nothing was made of the map, since it is not certified\n");
    return;
  }
  if (!folder_of(arguments).empty()) make_folder(folder_of(arguments));
  write_products(arguments, folder_of(arguments), carried,
                 {*surfaces[0], *surfaces[1], result.map, *result.composed});
}

}  // namespace

int map_command(const MapArguments& arguments) {
  const Stopwatch total;
  require_sound_source(arguments);
  require_sound_products(arguments);
  require_inputs_kept(arguments);
  const Stopwatch reading;
  const MappedInput a = read_surface(surface_input(arguments.a, arguments));
  const MappedInput b = read_surface(surface_input(arguments.b, arguments));
  const Surface &on_a = *a.input.surface, &on_b = *b.input.surface;
  const CarriedInputs carried(arguments, on_a, on_b);
  const double read_seconds = reading.seconds();
  SurfaceMap map =
      arguments.from.empty() ? sought_map(arguments, on_a, on_b) : stored_map(arguments, on_a, on_b);

  const Stopwatch composing;
  const Mapped result = mapped(on_a, on_b, std::move(map));
  Timings timings = {{"read", read_seconds}};
  timings.insert(timings.end(), result.map.timings.begin(), result.map.timings.end());
  timings.emplace_back("compose", composing.seconds());
  timings.emplace_back("total", total.seconds());
  std::array<RunRecord, 2> runs = {a.run, b.run};
  for (const int side : {0, 1}) {
    RunRecord& run = runs[side];
    run.total_seconds = total.seconds();
    run.peak_memory_bytes = peak_memory_bytes();
    const EmbedResult& embedded = side == 0 ? result.map.a : result.map.b;
    run.strain = strain_statistics(measure_strain(side == 0 ? on_a : on_b, embedded.embedding).at_vertices);
  }
  // What was measured when the map was sought is in its file.
  const std::string json = arguments.from.empty() ? map_json(result.map, result.composed, timings)
                                                  : read_file(in_folder(arguments.from, "map.json"));
  if (arguments.from.empty() && !arguments.output.empty()) write_map(arguments.output, result, runs, json);
  write_all_products(arguments, carried, result, {&on_a, &on_b});
  if (arguments.json) fmt::print("{}", json);
  if (!arguments.quiet) summarize(result.map, result.composed);
  explain('A', result.map.a);
  explain('B', result.map.b);
  if (result.composed) explain(result.composed->certificate);
  return exit_code(result.map, result.composed);
}

}  // namespace orbitutte::cli
