// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/cone_weights.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <set>

namespace orbitutte {
namespace {

constexpr double widest = 0.99 * std::numbers::pi;  // angle of a face

// The sides of some faces in place of those that edges have: of each face's half-edges, in their order.
using Sides = std::map<int, std::array<double, 3>>;

double side(const IntrinsicTriangulation& T, int h) { return T.length[T.connectivity.edge_of[h]]; }

// The angle of its face where a half-edge begins.
double angle_at_origin(const IntrinsicTriangulation& T, int h) {
  return 2 *
         std::atan(half_angle_tangent(side(T, next_halfedge(h)), side(T, previous_halfedge(h)), side(T, h)));
}

// The third side of a triangle from two sides and the angle between them.
double third_side(double p, double q, double angle) {
  const double sine = std::sin(angle / 2);
  return std::sqrt((p - q) * (p - q) + 4 * p * q * sine * sine);
}

// Half-edges that begin at vertex v, of faces without another cone.
std::vector<int> leaving(const IntrinsicTriangulation& T, int v, const std::vector<ConeAngle>& cones) {
  const auto is_cone = [&](int u) {
    return std::any_of(cones.begin(), cones.end(), [&](const ConeAngle& cone) { return cone.vertex == u; });
  };
  std::vector<int> result;
  for (int h = 0; h < static_cast<int>(T.F.size()); ++h)
    if (origin(T.F, h) == v && !is_cone(target(T.F, h)) && !is_cone(origin(T.F, previous_halfedge(h))))
      result.push_back(h);
  return result;
}

double angle_sum(const IntrinsicTriangulation& T, int v) {
  double sum = 0;
  for (int h = 0; h < static_cast<int>(T.F.size()); ++h)
    if (origin(T.F, h) == v) sum += angle_at_origin(T, h);
  return sum;
}

// The faces at a cone in the metric of z -> z^b.
void flatten(const IntrinsicTriangulation& T, const ConeAngle& cone, const std::vector<ConeAngle>& cones,
             Sides& sides) {
  const double b = cone.angle / angle_sum(T, cone.vertex);
  for (const int h : leaving(T, cone.vertex, cones)) {
    const double p = std::pow(side(T, h), b), q = std::pow(side(T, previous_halfedge(h)), b);
    std::array<double, 3>& of_face = sides[h / 3];
    of_face[h % 3] = p;
    of_face[previous_halfedge(h) % 3] = q;
    of_face[next_halfedge(h) % 3] = third_side(p, q, std::min(b * angle_at_origin(T, h), widest));
  }
}

double half_cotangent_at(const IntrinsicTriangulation& T, const Sides& sides, int h) {
  const int next = next_halfedge(h), previous = previous_halfedge(h);
  const auto at = sides.find(h / 3);
  if (at == sides.end()) return half_cotangent(side(T, h), side(T, next), side(T, previous));
  return half_cotangent(at->second[h % 3], at->second[next % 3], at->second[previous % 3]);
}

}  // namespace

EdgeWeights sharpened_at_cones(EdgeWeights weights, const std::vector<ConeAngle>& cones) {
  if (!weights.triangulation) return weights;
  const IntrinsicTriangulation& T = *weights.triangulation;
  Sides sides;
  for (const ConeAngle& cone : cones) flatten(T, cone, cones, sides);
  std::set<int> halfedges;  // one of each edge of those faces
  for (const auto& [f, of_face] : sides)
    for (int h = 3 * f; h < 3 * f + 3; ++h) halfedges.insert(std::max(h, T.connectivity.opposite[h]));
  for (const int h : halfedges) {
    const int opposite = T.connectivity.opposite[h], e = T.connectivity.edge_of[h];
    double before = half_cotangent_at(T, {}, h), now = half_cotangent_at(T, sides, h);
    if (opposite >= 0) {
      before += half_cotangent_at(T, {}, opposite);
      now += half_cotangent_at(T, sides, opposite);
    }
    weights.clamped_edges += (is_negative(now) ? 1 : 0) - (is_negative(before) ? 1 : 0);
    weights.w[e] = positive_weight(now, weights.clamp);
  }
  return weights;
}

}  // namespace orbitutte
