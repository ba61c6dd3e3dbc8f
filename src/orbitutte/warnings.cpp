// SPDX-License-Identifier: MIT
#include "orbitutte/warnings.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <unordered_set>

#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

// How many of the faces are among the collapsing ones, or share at least an edge with one of them.
long count_in_or_beside(const std::vector<int>& collapsing, const FaceView& faces,
                        const std::vector<int>& among) {
  std::unordered_set<int> vertices;
  for (const int f : collapsing) vertices.insert(faces[f].begin(), faces[f].end());
  return std::count_if(among.begin(), among.end(), [&](int f) {
    return std::count_if(faces[f].begin(), faces[f].end(), [&](int v) { return vertices.count(v) > 0; }) > 1;
  });
}

// The signed volume of the tetrahedron between a triangle and the origin, multiplied by 6.
double six_volumes(const Vector3& a, const Vector3& b, const Vector3& c) { return a.cross(b).dot(c); }

}  // namespace

std::vector<std::string> warnings_about(const EdgeWeights& weights, const std::vector<Ear>& ears) {
  std::vector<std::string> warnings;
  if (weights.zero_edges > 0)
    warnings.push_back(fmt::format("{} edges have the weight zero, but the theory needs positive weights",
                                   weights.zero_edges));
  if (!ears.empty())
    warnings.push_back(
        fmt::format("{} must become arcs, beginning with face {}: all edges but one lie on one mirror or "
                    "held side; they get just enough area for the certificate; for more, swap their inner "
                    "edges, or mark their tips",
                    counted(count_faces(ears), "face"), ears.front().face));
  return warnings;
}

std::vector<std::string> warnings_of_orientation(const Surface& surface) {
  constexpr double rounding = 1e-12;  // of a volume, relative to those of which it is the sum
  if (surface.topology != Topology::sphere) return {};
  const Triangles& F = surface.triangles;
  const Vector3 base = surface.V.row(F(0, 0));
  const auto volume_of_face = [&](int f) {
    const auto corner = [&](int k) -> Vector3 { return surface.V.row(F(f, k)).transpose() - base; };
    return six_volumes(corner(0), corner(1), corner(2));
  };
  const int m = surface.triangle_count();
  const double volume = parallel_sum(m, volume_of_face);
  if (!(volume < 0)) return {};
  const double size = parallel_sum(m, [&](int f) { return std::abs(volume_of_face(f)); });
  if (!(volume < -rounding * size)) return {};
  return {
      fmt::format("the mesh is inside out: its faces run clockwise if they are seen from outside, and its "
                  "volume is {:.4g}; the map is its mirror image, unless you turn all faces over",
                  volume / 6)};
}

std::vector<std::vector<int>> mirrors_of(const Tile& tile, const BoundaryConditions& boundary,
                                         const std::vector<int>& source_vertex) {
  std::vector<std::vector<int>> mirrors;
  for (std::size_t s = 0; s < tile.sides.size(); ++s) {
    if (!tile.sides[s].held() && tile.sides[s].partner != static_cast<int>(s)) continue;
    std::vector<int>& mirror = mirrors.emplace_back();
    for (const int v : boundary.sides[s]) mirror.push_back(source_vertex[v]);
  }
  // A cut that ends at a point of a mirror divides it into two sides.
  if (mirrors.size() == 2 &&
      std::any_of(tile.sides.begin(), tile.sides.end(), [](const TileSide& side) { return side.slides; })) {
    mirrors[1].insert(mirrors[1].end(), mirrors[0].begin() + 1, mirrors[0].end());
    mirrors.erase(mirrors.begin());
  }
  return mirrors;
}

std::vector<std::string> warnings_of_collapse(const FaceView& faces, const std::vector<int>& collapsing,
                                              const std::vector<int>& nonpositive) {
  if (collapsing.empty()) return {};
  const long unavoidable = count_in_or_beside(collapsing, faces, nonpositive);
  return {fmt::format(
      "{} must become arcs or points, the first face {}: the mesh is not 3-connected there (see "
      "'orbitutte info'). Of the {} that are not positive, {} belong to these or lie beside them, "
      "and no solver can do better; mark a vertex there, or split an inner edge",
      counted(std::ssize(collapsing), "face"), collapsing.front(), counted(std::ssize(nonpositive), "face"),
      unavoidable)};
}

std::string warning_of_replaced_weights(const EmbedResult& standard, const EmbedResult& taken) {
  const std::string fault =
      standard.certificate.bijective
          ? fmt::format(
                "fit this mesh badly: {} vertices would have to be moved for a bijection, and angles "
                "would be distorted {:.3g}-fold in the mean over the surface",
                standard.moved_vertices.size(), standard.distortion.angle.area_mean)
          : fmt::format("turn {} faces over", standard.certificate.nonpositive_faces.size());
  return fmt::format("the standard weights ('{}') {}; '{}' were taken instead; '--weights {}' insists",
                     name_of(standard.weights.kind), fault, name_of(taken.weights.kind),
                     name_of(standard.weights.kind));
}

}  // namespace orbitutte
