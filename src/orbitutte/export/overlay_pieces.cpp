// SPDX-License-Identifier: MIT
#include "orbitutte/export/overlay_pieces.h"

#include <fmt/format.h>

#include <algorithm>

#include "orbitutte/errors.h"

namespace orbitutte {
namespace {

// Shares beside a triangle that rounding may leave.
constexpr double rounding_share = 1e-9;

int source_corner(const Embedding& embedding, int triangle, int k) {
  return embedding.source_vertex[embedding.triangles(triangle, k)];
}

}  // namespace

Vector3 coordinates_in(const Embedding& embedding, const SurfacePoints& points, int point, int triangle) {
  const int own = points.triangle[point];
  Vector3 given = points.barycentric.row(point);
  if (own == triangle) return given;
  Vector3 result = Vector3::Zero();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k)
      if (source_corner(embedding, own, i) == source_corner(embedding, triangle, k)) result[k] += given[i];
  if (result.sum() < 1 - rounding_share)
    throw ArgumentError(
        fmt::format("point {} lies in triangle {}, not in triangle {}", point, own, triangle));
  return result / result.sum();
}

OverlayPieces overlay_pieces(const Overlay& overlay) {
  OverlayTriangles divided = overlay_triangles(overlay);
  OverlayPieces pieces;
  pieces.triangles = std::move(divided.triangles);
  pieces.on_a.reserve(divided.face.size());
  pieces.on_b.reserve(divided.face.size());
  for (const int face : divided.face) {
    pieces.on_a.push_back(overlay.parents[face].a);
    pieces.on_b.push_back(overlay.parents[face].b);
  }
  return pieces;
}

Points shown_colours(const Surface& surface) {
  if (surface.colours.rows() == surface.V.rows()) return surface.colours;
  constexpr double darkest = 0.15, brightest = 0.95;
  const auto low = surface.V.colwise().minCoeff().eval();
  Points colours = surface.V.rowwise() - low;
  for (int axis = 0; axis < 3; ++axis) {
    const double size = std::max(colours.col(axis).maxCoeff(), 1e-300);
    colours.col(axis) = darkest + (brightest - darkest) / size * colours.col(axis).array();
  }
  return colours;
}

}  // namespace orbitutte
