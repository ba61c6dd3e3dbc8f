// SPDX-License-Identifier: MIT
#include "command_arguments.h"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>

#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/mesh_io.h"
#include "orbitutte/mesh/triangulation.h"

namespace orbitutte::cli {
namespace {

// The triangles of the cut mesh's polygons, as those of the input's were divided. Where a polygon was turned
// over, its corners run the other way from the first on, and its triangles do, too.
Faces cut_triangles(const Triangulation& triangulation, const PolygonMesh& mesh, const Embedding& embedding) {
  std::vector<int> corners = embedding.polygons.corners;
  std::vector<char> turned(mesh.face_count(), 0);
  for (int f = 0; f < mesh.face_count(); ++f) {
    const int first = mesh.face_start[f];
    turned[f] = embedding.source_vertex[corners[first + 1]] != mesh.corners[first + 1];
    if (turned[f]) std::reverse(corners.begin() + first + 1, corners.begin() + mesh.face_start[f + 1]);
  }
  Faces triangles = on_vertices(triangulation, corners);
  int row = 0;
  for (int f = 0; f < mesh.face_count(); ++f)
    for (int k = 2; k < mesh.face_degree(f); ++k, ++row)
      if (turned[f]) std::swap(triangles(row, 1), triangles(row, 2));
  return triangles;
}

}  // namespace

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

WeightKind parse_weights(const std::string& text) {
  for (const WeightKind kind : {WeightKind::standard, WeightKind::cotan, WeightKind::delaunay,
                                WeightKind::mean_value, WeightKind::uniform})
    if (text == name(kind)) return kind;
  throw ArgumentError(
      fmt::format("--weights is '{}'; it may be standard, cotan, delaunay, mean-value or uniform", text));
}

SourceMesh read_source(const std::string& path, Embedding& embedding) {
  PolygonMesh mesh = read_mesh(path);
  require_embeddable(inspect(mesh));
  Points colours = std::move(mesh.colours);
  if (is_triangle_mesh(mesh)) return {to_triangle_mesh(std::move(mesh)), std::move(colours)};
  const Triangulation triangulation = triangulate(mesh);
  if (embedding.polygons.start == mesh.face_start)
    embedding.faces = cut_triangles(triangulation, mesh, embedding);
  return {{std::move(mesh.V), on_vertices(triangulation, mesh.corners)}, std::move(colours)};
}

}  // namespace orbitutte::cli
