// SPDX-License-Identifier: MIT
#include "command_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/io/mesh_io.h"

namespace orbitutte::cli {

std::vector<int> parse_cones(const std::string& text) {
  std::vector<int> cones;
  for (std::size_t from = 0; from <= text.size();) {
    const std::size_t end = std::min(text.find(',', from), text.size());
    int vertex = 0;
    const auto [stop, error] = std::from_chars(text.data() + from, text.data() + end, vertex);
    if (error != std::errc() || stop != text.data() + end)
      throw ArgumentError(
          fmt::format("--cones is '{}'; give vertices separated by commas, as in 12,40,7, or 'auto'", text));
    cones.push_back(vertex);
    from = end + 1;
  }
  return cones;
}

Surface read_source(const std::string& path, Embedding& embedding) {
  Surface surface = make_surface(read_mesh(path));
  if (embedding.polygons.start == surface.polygons.start)
    embedding.triangles = cut_triangles(surface, embedding);
  return surface;
}

}  // namespace orbitutte::cli
