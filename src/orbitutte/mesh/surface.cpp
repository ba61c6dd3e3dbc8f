// SPDX-License-Identifier: MIT
#include "orbitutte/mesh/surface.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>

#include "orbitutte/parallel.h"

namespace orbitutte {

double Surface::area(Eigen::Index triangle) const {
  const auto corner = [&](int k) -> Vector3 { return V.row(triangles(triangle, k)); };
  return 0.5 * (corner(1) - corner(0)).cross(corner(2) - corner(0)).norm();
}

double Surface::total_area() const {
  return parallel_sum(triangle_count(), [&](int t) { return area(t); });
}

std::vector<char> Surface::boundary_vertices() const {
  std::vector<char> result(vertex_count(), 0);
  for (int h = 0; h < static_cast<int>(triangles.size()); ++h)
    if (connectivity.opposite[h] < 0) result[halfedge_origin(triangles, h)] = 1;
  return result;
}

Polygons Surface::polygons_on(const Triangles& cut, const std::vector<char>& turned) const {
  Polygons result;
  if (!has_polygons()) return result;
  result.start = polygons.start;
  result.corners.resize(polygons.corners.size());
  int triangle = 0;
  for (int f = 0; f < result.count(); ++f) {
    const bool is_turned = !turned.empty() && turned[triangle] != 0;
    const std::array<int, 3> slot = is_turned ? std::array{0, 2, 1} : std::array{0, 1, 2};
    for (int k = 2; k < result.start[f + 1] - result.start[f]; ++k, ++triangle)
      for (int c = 0; c < 3; ++c) result.corners[division(triangle, c)] = cut(triangle, slot[c]);
    if (is_turned)
      std::reverse(result.corners.begin() + result.start[f] + 1,
                   result.corners.begin() + result.start[f + 1]);
  }
  return result;
}

Eigen::VectorXd Surface::vertex_areas() const {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(vertex_count());
  for (Eigen::Index f = 0; f < triangles.rows(); ++f) {
    const double third = area(f) / 3;
    for (const int v : triangles.row(f)) areas[v] += third;
  }
  return areas;
}

Points vertex_normals(const Points& V, const Triangles& F) {
  Points normals = Points::Zero(V.rows(), 3);
  for (const auto& v : F.rowwise()) {
    const Vector3 a = V.row(v[0]), b = V.row(v[1]), c = V.row(v[2]);
    const Vector3 normal = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) normals.row(v[k]) += normal.transpose();
  }
  for (Eigen::Index v = 0; v < V.rows(); ++v) {
    const Vector3 sum = normals.row(v);
    normals.row(v) = (sum.isZero(0) ? Vector3(Vector3::UnitZ()) : sum.stableNormalized()).transpose();
  }
  return normals;
}

}  // namespace orbitutte
