// SPDX-License-Identifier: MIT
#include "orbitutte/verify/angle_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "orbitutte/geometry/geodesic_triangle.h"
#include "orbitutte/mesh/connectivity.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

using Corners = std::array<Vector3, 3>;
using Angles = std::array<double, 3>;

template <int k>
double angle_at(Curvature<k> curvature, int i, const Corners& p, const Corners& edge) {
  return angle_between(curvature, p[i], edge[i], -edge[(i + 2) % 3]);
}

// Those of a triangle that is positively oriented are positive, even where rounding turns a sliver over; the
// third is what Gauss and Bonnet leave.
template <int k>
Angles positive_angles(Curvature<k> curvature, double area, const Corners& p, const Corners& edge) {
  const double first = std::abs(angle_at(curvature, 0, p, edge)),
               second = std::abs(angle_at(curvature, 1, p, edge));
  return {first, second, std::numbers::pi + k * area - first - second};
}

template <int k>
Angles signed_angles(Curvature<k> curvature, const Corners& p, const Corners& edge) {
  return {angle_at(curvature, 0, p, edge), angle_at(curvature, 1, p, edge), angle_at(curvature, 2, p, edge)};
}

// The same power of two for all three, so that the products of differences of 1e-200 are no zeros.
double scale_of(const Corners& edge) {
  const double longest =
      std::max({edge[0].cwiseAbs().maxCoeff(), edge[1].cwiseAbs().maxCoeff(), edge[2].cwiseAbs().maxCoeff()});
  return longest > 0 && longest < 1e-100 ? std::ldexp(1.0, std::min(-std::ilogb(longest), 1000)) : 1;
}

// The corners of a triangle and its edges, the first from corner 0 to corner 1.
std::pair<Corners, Corners> corners_and_edges(const ExactPositions& positions, const std::array<int, 3>& v) {
  return {{positions.rounded(v[0]), positions.rounded(v[1]), positions.rounded(v[2])},
          positions.edges(v[0], v[1], v[2])};
}

}  // namespace

TriangleSums sum_over_triangles(const Embedding& triangles, const ExactPositions& positions) {
  const int m = static_cast<int>(triangles.triangles.rows());
  std::vector<Angles> angles(m);
  TriangleSums sums = {std::vector<char>(m), 0, {}};
  visit_curvature(triangles.space(), [&](auto curvature) {
    sums.signed_area = parallel_sum(m, [&](int f) {
      const std::array<int, 3> v = {triangles.triangles(f, 0), triangles.triangles(f, 1),
                                    triangles.triangles(f, 2)};
      auto [corners, edges] = corners_and_edges(positions, v);
      const double area = area_between(curvature, corners[0], edges[0], -edges[2]);
      if (const double scale = scale_of(edges); scale != 1)
        for (Vector3& edge : edges) edge *= scale;  // angles are those of directions
      sums.positive[f] = positions.orientation(v[0], v[1], v[2]) > 0;
      angles[f] = sums.positive[f] ? positive_angles(curvature, area, corners, edges)
                                   : signed_angles(curvature, corners, edges);
      return area;
    });
  });
  sums.angle.assign(triangles.source_vertex.size(), 0.0);
  for (int f = 0; f < m; ++f)
    for (int i = 0; i < 3; ++i)
      sums.angle[surface_vertex(triangles, triangles.triangles(f, i))] += angles[f][i];
  return sums;
}

std::vector<double> rounding_of_angles(const Embedding& triangles, const ExactPositions& positions,
                                       const std::vector<char>& is_asked) {
  std::vector<double> allowed(triangles.source_vertex.size(), 0.0);
  for (int h = 0; h < static_cast<int>(triangles.triangles.size()); ++h) {
    const int* const face = triangles.triangles.data() + h / 3 * 3;
    const int p = face[h % 3], vertex = surface_vertex(triangles, p);
    if (!is_asked[vertex]) continue;
    for (const int q : {face[(h + 1) % 3], face[(h + 2) % 3]})
      allowed[vertex] += 16 * std::max(positions.rounding(p), positions.rounding(q)) / positions.chord(p, q);
  }
  return allowed;
}

std::vector<double> shortest_edges(const Embedding& triangles, const ExactPositions& positions,
                                   const std::vector<char>& is_asked) {
  std::vector<double> shortest(triangles.source_vertex.size(), std::numeric_limits<double>::infinity());
  const Triangles& F = triangles.triangles;
  const std::vector<int> asked = parallel_select(static_cast<int>(F.size()), [&](int h) {
    return is_asked[halfedge_origin(F, h)] || is_asked[halfedge_target(F, h)];
  });
  for (const int h : asked) {
    const int p = halfedge_origin(F, h), q = halfedge_target(F, h);
    const double length = positions.chord(p, q);
    for (const int v : {p, q})
      if (is_asked[v]) shortest[v] = std::min(shortest[v], length);
  }
  return shortest;
}

}  // namespace orbitutte
