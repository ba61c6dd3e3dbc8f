// SPDX-License-Identifier: MIT
#include <filesystem>

#include "commands.h"
#include "orbitutte/mesh/mesh_io.h"
#include "orbitutte/output/render.h"

namespace orbitutte::cli {
namespace {

constexpr int drawn = 0;

// What can be said before the mesh is read.
RenderOptions options_from(const RenderArguments& arguments) {
  RenderOptions options;
  options.panel = parse_panel(arguments.panel);
  if (!arguments.size.empty()) parse_size(arguments.size, options);
  if (!arguments.up.empty()) options.up = parse_up(arguments.up);
  return options;
}

}  // namespace

int render_command(const RenderArguments& arguments) {
  RenderOptions options = options_from(arguments);
  const Report report = read_report(arguments.report);
  const Embedding embedding = read_embedding(arguments.embedding, report);
  const Mesh mesh = to_triangle_mesh(read_mesh(arguments.mesh));
  if (!arguments.view.empty())
    options.view = parse_view(arguments.view, options.up ? *options.up : default_up(mesh));
  const std::string title = std::filesystem::path(arguments.mesh).filename().string();
  write_picture(arguments.output, {mesh, embedding, report, title}, options);
  return drawn;
}

}  // namespace orbitutte::cli
