// SPDX-License-Identifier: MIT
// Edge collapses by meshoptimizer, after M. Garland and P. Heckbert, Surface simplification using quadric
// error metrics (1997).
#include "orbitutte/export/display_mesh.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cstdint>
#include <limits>

namespace orbitutte {
namespace {

using FloatPoints = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// No collapse is too coarse: only the number of triangles matters.
constexpr float any_error = std::numeric_limits<float>::max();

/// The points at which collapses measure their error: the source in a unit box, plus half the image. With the
/// source alone, flat parts that are round on the sphere would collapse; with the image alone, limbs that are
/// tiny there would.
FloatPoints source_and_image(const Surface& surface, const Embedding& embedding) {
  const Eigen::RowVector3d low = surface.V.colwise().minCoeff();
  const double size = std::max((surface.V.colwise().maxCoeff() - low).maxCoeff(), 1e-300);
  FloatPoints points(embedding.positions.rows(), 3);
  for (Eigen::Index v = 0; v < points.rows(); ++v) {
    const Eigen::RowVector3d source = (surface.V.row(embedding.source_vertex[v]) - low) / size;
    points.row(v) = (source + 0.5 * embedding.positions.row(v)).cast<float>();
  }
  return points;
}

std::size_t simplify(std::vector<unsigned>& indices, const FloatPoints& points, std::size_t target) {
  constexpr std::size_t stride = 3 * sizeof(float);
  const std::size_t vertices = static_cast<std::size_t>(points.rows());
#if MESHOPTIMIZER_VERSION >= 180
  return meshopt_simplify(indices.data(), indices.data(), indices.size(), points.data(), vertices, stride,
                          target, any_error, meshopt_SimplifyLockBorder, nullptr);
#else
  return meshopt_simplify(indices.data(), indices.data(), indices.size(), points.data(), vertices, stride,
                          target, any_error, nullptr);
#endif
}

/// Fewer triangles on the same vertices, as close to `limit` as the fixed outline permits.
Triangles coarsened(const Triangles& faces, const FloatPoints& points, int limit) {
  if (faces.rows() <= limit) return faces;
  std::vector<unsigned> indices(faces.data(), faces.data() + faces.size());
  const std::size_t count = simplify(indices, points, 3 * static_cast<std::size_t>(limit));
  Triangles result(static_cast<Eigen::Index>(count / 3), 3);
  std::copy_n(indices.begin(), count, result.data());
  return result;
}

/// The edges that lie in only one face.
std::vector<std::array<int, 2>> outline(const Triangles& faces) {
  std::vector<std::uint64_t> edges;
  edges.reserve(static_cast<std::size_t>(faces.size()));
  for (Eigen::Index f = 0; f < faces.rows(); ++f) {
    for (int k = 0; k < 3; ++k) {
      const auto [low, high] = std::minmax({faces(f, k), faces(f, (k + 1) % 3)});
      edges.push_back(static_cast<std::uint64_t>(low) << 32 | static_cast<std::uint64_t>(high));
    }
  }
  std::sort(edges.begin(), edges.end());
  std::vector<std::array<int, 2>> result;
  for (auto at = edges.begin(); at != edges.end();) {
    const auto next = std::find_if(at, edges.end(), [&](std::uint64_t edge) { return edge != *at; });
    if (next - at == 1) result.push_back({static_cast<int>(*at >> 32), static_cast<int>(*at & 0xffffffffu)});
    at = next;
  }
  return result;
}

/// The vertices that the faces use, ascending; the faces are renumbered to match.
std::vector<int> compact(Triangles& faces, int vertices) {
  std::vector<int> number(vertices, -1);
  for (const int v : faces.reshaped()) number[v] = 0;
  std::vector<int> kept;
  for (int v = 0; v < vertices; ++v) {
    if (number[v] < 0) continue;
    number[v] = static_cast<int>(kept.size());
    kept.push_back(v);
  }
  for (int& v : faces.reshaped()) v = number[v];
  return kept;
}

FloatPoints image(const Embedding& embedding, const std::vector<int>& cut_vertex) {
  return embedding.positions(cut_vertex, Eigen::all).cast<float>();
}

}  // namespace

DisplayMesh display_mesh(const Surface& surface, const Embedding& embedding, const DisplayLimits& limits) {
  DisplayMesh result;
  result.fine.faces = embedding.triangles;
  if (embedding.triangles.rows() > limits.faces)
    result.fine.faces = coarsened(embedding.triangles, source_and_image(surface, embedding), limits.faces);
  result.cut_vertex = compact(result.fine.faces, static_cast<int>(embedding.positions.rows()));
  result.fine.outline = outline(result.fine.faces);

  const int share = limits.tiling_faces / std::max(embedding.target.group_order, 1);
  result.coarse.faces = coarsened(result.fine.faces, image(embedding, result.cut_vertex), share);
  result.coarse.outline = outline(result.coarse.faces);
  return result;
}

}  // namespace orbitutte
