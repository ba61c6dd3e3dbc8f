// SPDX-License-Identifier: MIT
#include "orbitutte/verify/angle_sums.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "orbitutte/geometry/geodesic_triangle.h"
#include "orbitutte/parallel.h"

namespace orbitutte {
namespace {

struct TriangleMeasures {
  double area = 0;
  std::array<double, 3> angle;
};

template <int k>
TriangleMeasures measure(Curvature<k> curvature, const std::array<Vector3, 3>& p,
                         const std::array<Vector3, 3>& edge) {
  TriangleMeasures result;
  result.area = area_between(curvature, p[0], edge[0], -edge[2]);
  for (int i = 0; i < 3; ++i) result.angle[i] = angle_between(curvature, p[i], edge[i], -edge[(i + 2) % 3]);
  return result;
}

// The same power of two for all three, so that the products of differences of 1e-200 are no zeros.
double scale_of(const std::array<Vector3, 3>& edge) {
  const double longest =
      std::max({edge[0].cwiseAbs().maxCoeff(), edge[1].cwiseAbs().maxCoeff(), edge[2].cwiseAbs().maxCoeff()});
  return longest > 0 && longest < 1e-100 ? std::ldexp(1.0, std::min(-std::ilogb(longest), 1000)) : 1;
}

template <int k>
TriangleMeasures measure_exactly(Curvature<k> curvature, const ExactPositions& positions,
                                 const std::array<int, 3>& v) {
  const std::array<Vector3, 3> p = {positions.rounded(v[0]), positions.rounded(v[1]),
                                    positions.rounded(v[2])};
  std::array<Vector3, 3> edge = positions.edges(v[0], v[1], v[2]);
  const double scale = scale_of(edge);
  TriangleMeasures result = measure(curvature, p, edge);
  if (scale == 1) return result;
  for (Vector3& e : edge) e *= scale;
  result.angle = measure(curvature, p, edge).angle;  // of directions
  return result;
}

}  // namespace

TriangleSums sum_over_triangles(const Embedding& triangles, const ExactPositions& positions) {
  const Points& X = triangles.positions;
  const int m = static_cast<int>(triangles.triangles.rows());
  std::vector<std::array<double, 3>> angles(m);
  TriangleSums sums;
  visit_curvature(triangles.space(), [&](auto curvature) {
    sums.signed_area = parallel_sum(m, [&](int f) {
      const std::array<int, 3> v = {triangles.triangles(f, 0), triangles.triangles(f, 1),
                                    triangles.triangles(f, 2)};
      TriangleMeasures measures;
      if (positions.has_offsets(v[0]) || positions.has_offsets(v[1]) || positions.has_offsets(v[2])) {
        measures = measure_exactly(curvature, positions, v);
      } else {
        const Vector3 a = X.row(v[0]), b = X.row(v[1]), c = X.row(v[2]);
        measures = measure(curvature, {a, b, c}, {b - a, c - b, a - c});
      }
      angles[f] = measures.angle;
      return measures.area;
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
  for (int h = 0; h < static_cast<int>(triangles.triangles.size()); ++h) {
    const int* const face = triangles.triangles.data() + h / 3 * 3;
    const int p = face[h % 3], q = face[(h + 1) % 3];
    if (!is_asked[p] && !is_asked[q]) continue;
    const double length = positions.chord(p, q);
    for (const int v : {p, q})
      if (is_asked[v]) shortest[v] = std::min(shortest[v], length);
  }
  return shortest;
}

}  // namespace orbitutte
