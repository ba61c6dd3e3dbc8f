// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <cmath>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/io/vertex_data.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "orbitutte/verify/strain.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

const std::string all_measures = "all";

// The columns of the maps that are asked for.
std::vector<int> columns_of(const std::string& measure) {
  if (measure == all_measures) return {0, 1, 2, 3};
  if (const auto one = find_by_name<StrainMeasure>(measure)) return {static_cast<int>(*one)};
  std::vector<std::string> choices = choices_of<StrainMeasure>();
  choices.push_back(all_measures);
  refuse_choice(measure, "--measure", choices);
}

VertexData data_of(const StrainMap& map, const std::vector<int>& columns) {
  VertexData data;
  data.values = map.values(Eigen::all, columns);
  data.names.reserve(columns.size());
  for (const int column : columns)
    data.names.push_back("log2 " + name_of(static_cast<StrainMeasure>(column)));
  return data;
}

// Of faces, which formats of values at vertices cannot tell apart from those.
void require_format_for_faces(const std::string& path) {
  const VertexDataFormat format = vertex_data_format(path);
  if (format == VertexDataFormat::text || format == VertexDataFormat::csv || format == VertexDataFormat::npy)
    return;
  throw ArgumentError(fmt::format(
      "-o is '{}', but such files hold values of vertices; write those of faces as .csv, .txt or .npy",
      path));
}

void print_rows(const std::vector<StrainStatistics>& strain, const std::vector<int>& columns) {
  fmt::print("{:<6} {:>9} {:>9}", "log2", "mean", "mean abs");
  for (const int percent : StrainStatistics::percents) fmt::print(" {:>8}%", percent);
  fmt::print("\n");
  for (const int column : columns) {
    const StrainStatistics& row = strain[static_cast<std::size_t>(column)];
    fmt::print("{:<6} {:>9.4f} {:>9.4f}", name_of(static_cast<StrainMeasure>(column)), row.mean,
               row.mean_absolute);
    for (const double value : row.percentiles) fmt::print(" {:>9.4f}", value);
    fmt::print("\n");
  }
}

}  // namespace

int measure_command(const MeasureArguments& arguments) {
  const std::vector<int> columns = columns_of(arguments.measure);
  if (arguments.faces && !arguments.output.empty()) require_format_for_faces(arguments.output);
  if (arguments.radius && !(*arguments.radius > 0 && std::isfinite(*arguments.radius)))
    throw ArgumentError(fmt::format("--radius is {}; give a positive number", *arguments.radius));
  const Report report = read_report(arguments.report);
  Embedding embedding = read_embedding(arguments.embedding, report);
  warn(warnings_of_offsets(embedding));
  const Surface surface = read_source(mesh_input(arguments.mesh, arguments.format), report, embedding);
  require_cut_from(surface, embedding);
  const SurfaceStrain strain = measure_strain(surface, embedding, arguments.radius.value_or(0));
  const StrainMap& map = arguments.faces ? strain.on_faces : strain.at_vertices;
  if (!arguments.output.empty()) write_as_asked(arguments.output, data_of(map, columns));
  const std::vector<StrainStatistics> statistics = strain_statistics(map);
  if (arguments.json) {
    fmt::print("{}", strain_json(statistics));
  } else if (!arguments.quiet) {
    print_rows(statistics, columns);
    tell(
        "area: of the faces around a vertex; J: area ratio of triangles, R: their elongation; edge: lengths; "
        "0 is no distortion\n");
  }
  return succeeded;
}

}  // namespace orbitutte::cli
