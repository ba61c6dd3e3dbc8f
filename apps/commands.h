// SPDX-License-Identifier: MIT
// The commands, each with its arguments; all return the exit code.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/choose.h"
#include "orbitutte/export/sphere_surface.h"
#include "orbitutte/export/texture_chart.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/map/surface_map.h"
#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/options.h"
#include "orbitutte/render/render.h"
#include "orbitutte/samples/sample.h"

namespace orbitutte::cli {

/// With 4 and 5 the embedding has been written all the same.
enum ExitCode {
  succeeded = 0,
  file_trouble = 1,
  wrong_usage = 2,
  unsuitable_mesh = 3,
  not_converged = 4,
  not_certified = 5
};

/// What `embed`, and every job of `batch`, may be asked for beside its files.
struct EmbedWishes {
  /// Of the mesh; none, if it is empty.
  std::string format;
  std::string orbifold, cones, angles;
  std::string objective = name_of(Objective::sigma);
  std::string centre, points;
  std::string polygon, spread = name_of(Spread::arc_length);
  std::string weights = name_of(WeightKind::standard), weights_file;
  double clamp = 0.01, tolerance = 1e-9;
  /// Of fitted angles; a sigma of 0 and a count of 0 are none.
  double area = 0, sigma = 0;
  std::uint64_t cut_seed = 0;
  int count = 0, max_iterations = 2000;
  bool orders = false, quotient = false, floor = false, repair = false;
};

struct EmbedArguments : EmbedWishes {
  std::string mesh, output, report;
  int threads = 0;
  bool quiet = false, json = false;
};
int embed_command(const EmbedArguments& arguments);

/// Throws what can be said against the arguments before the mesh is read.
void require_sound(const EmbedArguments& arguments);

struct BatchArguments : EmbedWishes {
  /// A manifest, or meshes and patterns.
  std::vector<std::string> inputs;
  std::string output, memory_limit, shard;

  /// The wishes that were given, as on the command line: "--orbifold=432". They hold for all jobs.
  std::vector<std::string> common;
  double time_limit = 0;
  int jobs = 0;
  /// Negative: all.
  std::optional<int> job = {};
  bool again = false, list = false, summary = false, quiet = false;
};
int batch_command(const BatchArguments& arguments);

struct ChooseArguments {
  std::string mesh, format, orbifold, cones, output, picture;
  std::string objective = name_of(Objective::sigma), weights = name_of(WeightKind::standard);
  int solved = 3, threads = 0;
  bool json = false;
};
int choose_command(const ChooseArguments& arguments);

struct InfoArguments {
  std::string mesh, format;
  bool json = false;
};
int info_command(const InfoArguments& arguments);

struct TypesArguments {
  bool json = false;
};
int types_command(const TypesArguments& arguments);

struct VerifyArguments {
  std::string embedding, report, mesh, format, weights_file;
  bool theorem2 = false, json = false;
};
int verify_command(const VerifyArguments& arguments);

struct TileArguments {
  std::string embedding, report, output;
  int copies = default_plane_copies;
};
int tile_command(const TileArguments& arguments);

struct ExportArguments {
  std::string embedding, report, mesh, format, output, chart;
  double radius = brain_sphere_radius;
};
int export_command(const ExportArguments& arguments);

struct MeasureArguments {
  std::string embedding, report, mesh, format, output, measure = "all";
  /// None: that for which image and surface have the same area.
  std::optional<double> radius = {};
  bool faces = false, quiet = false, json = false;
};
int measure_command(const MeasureArguments& arguments);

struct RenderArguments {
  std::string embedding, report, mesh, format, output;
  std::string panel = name_of(Panel::sheet), view, up, size;
};
int render_command(const RenderArguments& arguments);

struct ReportArguments {
  std::string embedding, report, mesh, format, output, values, map = "0";
};
int report_command(const ReportArguments& arguments);

struct CompareArguments {
  std::string mesh, format, cones = "extremities", weights = name_of(WeightKind::standard), output, view, up;
  std::vector<std::string> orbifolds;
  bool json = false;
};
int compare_command(const CompareArguments& arguments);

struct RepairArguments {
  std::string mesh, format, output, report;
  std::vector<std::string> without;
  double weld = 0;
  /// Negative: all holes but the longest.
  std::optional<int> fill_holes = {};
  bool drop_flat = false, json = false;
};
int repair_command(const RepairArguments& arguments);

struct MapArguments {
  std::string a, b, landmarks, output, tour;
  /// Of the one that comes from standard input.
  std::string format;
  std::string weights = name_of(WeightKind::standard), tile = name_of(TileShape::shared);
  double clamp = 0.01, tolerance = 1e-13;
  std::uint64_t cut_seed_a = 0, cut_seed_b = 0;
  int max_iterations = 2000, threads = 0;
  bool quiet = false, json = false;

  /// A folder with a map, which is then not sought.
  std::string from;

  /// What is made of the map; frames: 0 if they are not asked for.
  std::string picture, view, up, page, colours, morph;
  std::string texture, texture_size, values, labels, curves;
  int frames = 0;
  bool new_chart = false;
};
int map_command(const MapArguments& arguments);

struct ResampleArguments {
  std::string embedding, report, mesh, format, values, grid, kind, output;
  /// The margin of images.
  int pad = 0;
  bool back = false;
};
int resample_command(const ResampleArguments& arguments);

struct SampleArguments {
  std::string output, shape = name_of(SampleShape::figure);
  int faces = 20000;
};
int sample_command(const SampleArguments& arguments);

/// Version, linear algebra and the licence of the binary.
std::string version_text();

}  // namespace orbitutte::cli
