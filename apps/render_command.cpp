// SPDX-License-Identifier: MIT
#include <filesystem>

#include "command_arguments.h"
#include "commands.h"
#include "map_products.h"
#include "orbitutte/render/map_sheet.h"
#include "orbitutte/render/render.h"
#include "orbitutte/report/embedding_file.h"
#include "page_pictures.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

constexpr int drawn = 0;

// The options that do not depend on the mesh.
RenderOptions options_from(const RenderArguments& arguments) {
  RenderOptions options;
  options.panel = parse_choice<Panel>(arguments.panel, "--panel");
  if (!arguments.size.empty()) parse_picture_size(arguments.size, options);
  return options;
}

}  // namespace

Viewpoint parse_viewpoint(const std::string& view, const std::string& up, const Surface& surface) {
  Viewpoint viewpoint;
  if (!up.empty()) viewpoint.up = parse_up_direction(up);
  if (!view.empty())
    viewpoint.view = parse_view_direction(view, viewpoint.up ? *viewpoint.up : default_up_direction(surface));
  return viewpoint;
}

int render_command(const RenderArguments& arguments) {
  RenderOptions options = options_from(arguments);
  const Report report = read_report(arguments.report);
  Embedding embedding = read_embedding(arguments.embedding, report);
  warn(warnings_of_offsets(embedding));
  const Surface surface = read_source(mesh_input(arguments.mesh, arguments.format), report, embedding);
  const Viewpoint viewpoint = parse_viewpoint(arguments.view, arguments.up, surface);
  options.view = viewpoint.view;
  options.up = viewpoint.up;
  const std::string title = std::filesystem::path(arguments.mesh).filename().string();
  write_picture(arguments.output, {surface, embedding, report, title}, options);
  tell("{}: {} of {}\n", arguments.output, name_of(options.panel), arguments.embedding);
  return drawn;
}

void write_scale_picture(const std::string& path, const Surface& surface, const Embedding& embedding,
                         const std::vector<int>& candidates) {
  RenderOptions options;
  options.panel = Panel::area;
  write_picture(path, {surface, embedding, Report(), "", candidates}, options);
}

void require_pictures(const std::string& view, const std::string& up) {
  const Vector3 direction = up.empty() ? Vector3(Vector3::UnitY()) : parse_up_direction(up);
  if (!view.empty()) parse_view_direction(view, direction);
}

std::string map_picture(const MapArguments& arguments, const MappedSurfaces& mapped) {
  const Viewpoint viewpoint = parse_viewpoint(arguments.view, arguments.up, mapped.a);
  return map_sheet_png({mapped.a, mapped.b, mapped.map, mapped.composed,
                        std::filesystem::path(arguments.a).filename().string(),
                        std::filesystem::path(arguments.b).filename().string(), viewpoint.view,
                        viewpoint.up});
}

std::vector<PagePicture> page_pictures(const Surface& surface, const Embedding& embedding,
                                       const Report& report) {
  std::vector<PagePicture> pictures;
  const std::vector<std::pair<Panel, std::string>> wanted = {
      {Panel::source, "The mesh, its marked vertices and seams"},
      {Panel::sphere, tile_caption(embedding)},
      {Panel::checkerboard, "A checkerboard through the map"},
      {Panel::area, "Area distortion"}};
  for (const auto& [panel, caption] : wanted) {
    RenderOptions options;
    options.panel = panel;
    options.width = options.height = 800;
    pictures.push_back({caption, render_png({surface, embedding, report, ""}, options)});
  }
  return pictures;
}

}  // namespace orbitutte::cli
