// SPDX-License-Identifier: MIT
#include "orbitutte/render/mesh_lines.h"

#include <Eigen/Geometry>
#include <algorithm>

#include "orbitutte/parallel.h"

namespace orbitutte {

double mean_edge_length(const Points& V, const Triangles& F) {
  if (F.rows() == 0) return 0;
  const double sum = parallel_sum(static_cast<int>(F.rows()), [&](int f) {
    double length = 0;
    for (int k = 0; k < 3; ++k) length += (V.row(F(f, (k + 1) % 3)) - V.row(F(f, k))).norm();
    return length;
  });
  return sum / static_cast<double>(F.size());
}

float line_strength(double edge_pixels) {
  return static_cast<float>(std::clamp((edge_pixels - 6) / 10, 0.0, 1.0));
}

float line_coverage(const Points& V, const Triangles& F, const Hit& hit, double pixel) {
  constexpr double half_width = 0.55;  // pixels
  const Vector3 a = V.row(F(hit.primitive, 0)), b = V.row(F(hit.primitive, 1)),
                c = V.row(F(hit.primitive, 2));
  const double twice_area = (b - a).cross(c - a).norm();
  // A barycentric coordinate times the triangle's height over the opposite side is the distance to that side.
  const auto distance = [&](double coordinate, const Vector3& side) {
    return coordinate * twice_area / std::max(side.norm(), 1e-12);
  };
  const double u = hit.u, v = hit.v;
  const double nearest = std::min({distance(1 - u - v, c - b), distance(u, c - a), distance(v, b - a)});
  return nearest < half_width * pixel ? 1 : 0;
}

}  // namespace orbitutte
