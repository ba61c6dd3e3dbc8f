// SPDX-License-Identifier: MIT
// The commands, each with its arguments; all return the exit code.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

#include "orbitutte/choose.h"
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

struct EmbedArguments {
  std::string mesh, orbifold, cones, angles, output, report;
  std::string objective = name_of(Objective::sigma);
  std::string centre, points;
  std::string polygon, spread = name_of(Spread::arc_length);
  std::string weights = name_of(WeightKind::standard), weights_file;
  double clamp = 0.01, tolerance = 1e-9;
  /// Of fitted angles; a sigma of 0 and a count of 0 are none.
  double area = 0, sigma = 0;
  std::uint64_t cut_seed = 0;
  int count = 0, max_iterations = 2000, threads = 0;
  bool orders = false, quotient = false, floor = false, quiet = false, json = false;
};
int embed_command(const EmbedArguments& arguments);

struct ChooseArguments {
  std::string mesh, orbifold, cones, output, picture;
  std::string objective = name_of(Objective::sigma), weights = name_of(WeightKind::standard);
  int solved = 3, threads = 0;
  bool json = false;
};
int choose_command(const ChooseArguments& arguments);

struct InfoArguments {
  std::string mesh;
  bool json = false;
};
int info_command(const InfoArguments& arguments);

struct TypesArguments {
  bool json = false;
};
int types_command(const TypesArguments& arguments);

struct VerifyArguments {
  std::string embedding, report, mesh, weights_file;
  bool theorem2 = false, json = false;
};
int verify_command(const VerifyArguments& arguments);

struct TileArguments {
  std::string embedding, report, output;
  int copies = default_plane_copies;
};
int tile_command(const TileArguments& arguments);

struct ExportArguments {
  std::string embedding, report, mesh, output, chart;
};
int export_command(const ExportArguments& arguments);

struct RenderArguments {
  std::string embedding, report, mesh, output;
  std::string panel = name_of(Panel::sheet), view, up, size;
};
int render_command(const RenderArguments& arguments);

struct ReportArguments {
  std::string embedding, report, mesh, output;
};
int report_command(const ReportArguments& arguments);

struct CompareArguments {
  std::string mesh, cones = "extremities", weights = name_of(WeightKind::standard), output, view, up;
  std::vector<std::string> orbifolds;
  bool json = false;
};
int compare_command(const CompareArguments& arguments);

struct RepairArguments {
  std::string mesh, output, report;
  std::vector<std::string> without;
  double weld = 0;
  /// Negative: all holes but the longest.
  int fill_holes = -1;
  bool drop_flat = false, json = false;
};
int repair_command(const RepairArguments& arguments);

struct MapArguments {
  std::string a, b, landmarks, output, tour;
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

struct SampleArguments {
  std::string output, shape = name_of(SampleShape::figure);
  int faces = 20000;
};
int sample_command(const SampleArguments& arguments);

/// Version, linear algebra and the licence of the binary.
std::string version_text();

}  // namespace orbitutte::cli
