// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <filesystem>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/export/value_colours.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/vertex_data.h"
#include "orbitutte/page/page.h"
#include "orbitutte/report/embedding_file.h"
#include "orbitutte/report/report.h"
#include "page_pictures.h"
#include "standard_streams.h"

namespace orbitutte::cli {

namespace {

// The name of a map or, if it has none, that of the file.
std::string name_of_values(const ReportArguments& arguments, const VertexData& data, Eigen::Index map) {
  if (!data.names.empty() && !data.names[map].empty()) return data.names[map];
  const std::string file = std::filesystem::path(arguments.values).filename().string();
  return data.values.cols() > 1 ? fmt::format("{}, map {}", file, map) : file;
}

// The colours of the values take the place of the mesh's own.
ShownValues show_values(const ReportArguments& arguments, Surface& surface) {
  const VertexData data = read_vertex_data(arguments.values);
  if (data.values.rows() != surface.V.rows())
    throw MeshError(
        fmt::format("{} has values of {} vertices, but the mesh has {}; take the file of this surface",
                    arguments.values, data.values.rows(), surface.V.rows()));
  const Eigen::Index map = find_map(data, arguments.map);
  ValueColours shown = value_colours(data, map);
  surface.colours = std::move(shown.colours);
  if (data.labels.empty())
    tell("{}: colours of vertices from {:.4g} to {:.4g}\n", arguments.values, shown.low, shown.high);
  return {name_of_values(arguments, data, map), data.values.col(map), data.labels, shown.low, shown.high};
}

}  // namespace

int report_command(const ReportArguments& arguments) {
  constexpr int written = 0;
  const Report claims = read_report(arguments.report);
  Embedding embedding = read_embedding(arguments.embedding, claims);
  warn(warnings_of_offsets(embedding));
  Surface surface = read_source(mesh_input(arguments.mesh, arguments.format), claims, embedding);
  PageOptions options;
  if (!arguments.values.empty()) options.values = show_values(arguments, surface);
  const std::string report = read_file(arguments.report);
  if (!has_interactive_view()) options.pictures = page_pictures(surface, embedding, claims);
  write_file(arguments.output, report_page({surface, embedding, report}, options));
  tell("{}: page of {}\n", arguments.output, arguments.embedding);
  if (!has_interactive_view())
    tell(
        "{} has no interactive view, which alone shows colours of vertices, because this program was built "
        "without Node.js\n",
        arguments.output);
  return written;
}

}  // namespace orbitutte::cli
