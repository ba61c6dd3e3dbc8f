// SPDX-License-Identifier: MIT
#include "orbitutte/weights/cone_weights.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/parallel.h"
#include "orbitutte/weights/delaunay_flips.h"

namespace orbitutte {
namespace {

constexpr double widest = 0.99 * std::numbers::pi;  // the largest angle of a face

// The angle of its face at the origin of half-edge h.
double angle_at_origin(const IntrinsicTriangulation& T, int h) {
  return std::atan2(1.0, 2 * T.half_cotangent[next_halfedge(h)]);
}

// The third side of a triangle with sides p and q and this angle between them.
double third_side(double p, double q, double angle) {
  const double sine = std::sin(angle / 2);
  return std::sqrt((p - q) * (p - q) + 4 * p * q * sine * sine);
}

// The half-edges that leave each cone.
std::vector<std::vector<int>> leaving(const IntrinsicTriangulation& T, const std::vector<ConeAngle>& cones) {
  const auto begins_at = [&](int h, const ConeAngle& cone) { return halfedge_origin(T.F, h) == cone.vertex; };
  const std::vector<int> at_cones = parallel_select(static_cast<int>(T.F.size()), [&](int h) {
    return std::any_of(cones.begin(), cones.end(), [&](const ConeAngle& cone) { return begins_at(h, cone); });
  });
  std::vector<std::vector<int>> result(cones.size());
  for (const int h : at_cones)
    for (std::size_t k = 0; k < cones.size(); ++k)
      if (begins_at(h, cones[k])) result[k].push_back(h);
  return result;
}

// Measures the face of h in the metric of z -> z^b; h leaves the cone.
void flatten(IntrinsicTriangulation& T, int h, double b) {
  const double p = std::pow(T.length[h], b), q = std::pow(T.length[previous_halfedge(h)], b);
  const double angle = std::min(b * angle_at_origin(T, h), widest);
  T.length[h] = p;
  T.length[previous_halfedge(h)] = q;
  T.length[next_halfedge(h)] = third_side(p, q, angle);
  measure_angles(T, h / 3);
}

bool joins_any(const IntrinsicTriangulation& T, const std::vector<std::array<int, 2>>& pairs) {
  const std::vector<std::array<int, 2>>& edges = T.connectivity.edges;
  return std::any_of(pairs.begin(), pairs.end(), [&](const std::array<int, 2>& pair) {
    return std::any_of(edges.begin(), edges.end(), [&](const std::array<int, 2>& edge) {
      return edge == pair || edge == std::array{pair[1], pair[0]};
    });
  });
}

}  // namespace

IntrinsicTriangulation flattened_at_cones(IntrinsicTriangulation T, const std::vector<ConeAngle>& cones) {
  const std::vector<std::vector<int>> halfedges = leaving(T, cones);
  std::vector<char> cones_of_face(T.F.rows(), 0);
  for (const std::vector<int>& of_cone : halfedges)
    for (const int h : of_cone) ++cones_of_face[h / 3];
  std::vector<int> changed;  // edges
  for (std::size_t k = 0; k < cones.size(); ++k) {
    double sum = 0;
    for (const int h : halfedges[k]) sum += angle_at_origin(T, h);
    for (const int h : halfedges[k]) {
      if (cones_of_face[h / 3] > 1) continue;
      flatten(T, h, cones[k].angle / sum);
      for (const int side : {h, next_halfedge(h), previous_halfedge(h)})
        changed.push_back(T.connectivity.edge_of[side]);
    }
  }
  make_delaunay(T, changed);
  return T;
}

EdgeWeights sharpened_at_cones(const EdgeWeights& weights, const std::vector<ConeAngle>& cones,
                               const std::vector<std::array<int, 2>>& apart) {
  if (!weights.triangulation) return weights;
  IntrinsicTriangulation T = *weights.triangulation;
  T.kept_apart = apart;
  return intrinsic_weights(flattened_at_cones(std::move(T), cones), weights.clamp);
}

IntrinsicTriangulation kept_apart(IntrinsicTriangulation T, const Surface& surface,
                                  const UnflippedEdges& unflipped) {
  if (joins_any(T, unflipped.kept_apart)) T = delaunay_triangulation(surface, unflipped);
  T.kept_apart = unflipped.kept_apart;
  return T;
}

EdgeWeights kept_apart(const EdgeWeights& weights, const Surface& surface, const WeightOptions& options,
                       const UnflippedEdges& unflipped) {
  if (!weights.triangulation || !joins_any(*weights.triangulation, unflipped.kept_apart)) return weights;
  return edge_weights(surface, options, unflipped);
}

}  // namespace orbitutte
