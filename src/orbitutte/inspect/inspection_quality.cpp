// SPDX-License-Identifier: MIT
// Areas, angles, lengths and cotangents of the triangles.
#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>

#include "orbitutte/inspect/inspection_steps.h"
#include "orbitutte/inspect/recognition.h"

namespace orbitutte::inspection {
namespace {

constexpr double zero_cotangent = 1e-12;  // rounding errors of a right angle, many times over

// The largest coordinate of a triangle's edges is the unit in which its area and angles are computed: nothing
// overflows.
struct Triangle {
  std::array<Vector3, 3> edge;  // edge[k] runs from corner k to the next, divided by `unit`
  double unit = 0;

  Triangle(const Points& V, int i, int j, int k) {
    edge = {V.row(j) - V.row(i), V.row(k) - V.row(j), V.row(i) - V.row(k)};
    for (const Vector3& e : edge) unit = std::max(unit, e.lpNorm<Eigen::Infinity>());
    for (Vector3& e : edge) e /= unit;
  }

  // Twice the area over the square of the unit.
  double doubled_area() const { return edge[0].cross(edge[1]).norm(); }

  double angle(int corner) const {
    const Vector3 &out = edge[corner], in = -edge[(corner + 2) % 3];
    return std::atan2(out.cross(in).norm(), out.dot(in));
  }

  // Of the angle at a corner; zero where the triangle has no area.
  double cotangent(int corner) const {
    const Vector3 &out = edge[corner], in = -edge[(corner + 2) % 3];
    const double cotangent = out.dot(in) / out.cross(in).norm();
    return std::isfinite(cotangent) ? cotangent : 0.0;
  }
};

Triangle triangle(const PolygonMesh& mesh, int f) {
  const int* corner = &mesh.corners[mesh.face_start[f]];
  return Triangle(mesh.V, corner[0], corner[1], corner[2]);
}

bool is_triangle(const Surface& s, int f) { return s.well_formed(f) && s.mesh.face_degree(f) == 3; }

void measure_triangles(const Surface& s, Inspection& result) {
  double min_angle = std::numeric_limits<double>::infinity(), min_edge = min_angle;
  for (int f = 0; f < result.faces; ++f) {
    if (!is_triangle(s, f)) continue;
    const Triangle t = triangle(s.mesh, f);
    const int* corner = &s.mesh.corners[s.mesh.face_start[f]];
    if (is_degenerate(s.mesh.V.row(corner[0]), s.mesh.V.row(corner[1]), s.mesh.V.row(corner[2]))) {
      ++result.zero_area_faces;
      continue;
    }
    result.area += 0.5 * t.doubled_area() * t.unit * t.unit;
    for (int k = 0; k < 3; ++k) {
      min_angle = std::min(min_angle, t.angle(k));
      result.max_angle = std::max(result.max_angle, t.angle(k));
      min_edge = std::min(min_edge, t.edge[k].norm() * t.unit);
      result.max_edge_length = std::max(result.max_edge_length, t.edge[k].norm() * t.unit);
    }
  }
  if (result.max_angle > 0) result.min_angle = min_angle, result.min_edge_length = min_edge;
}

// w_ij = (cot a + cot b)/2 over the angles opposite to the edge.
double cotangent_weight(const Surface& s, int e) {
  double weight = 0;
  for (int i = 0; i < s.faces_on(e); ++i) {
    const int h = s.half_edge(e, i), f = s.face_of[h];
    const int opposite = (h - s.mesh.face_start[f] + 2) % 3;
    weight += 0.5 * triangle(s.mesh, f).cotangent(opposite);
  }
  return weight;
}

void count_cotangents(const Surface& s, Inspection& result) {
  for (int e = 0; e < s.edge_count(); ++e) {
    const auto on_triangle = [&](int h) { return is_triangle(s, s.face_of[h]); };
    const auto begin = s.edges.items.begin() + s.edges.start[e],
               end = s.edges.items.begin() + s.edges.start[e + 1];
    if (s.faces_on(e) > 2 || !std::all_of(begin, end, on_triangle)) continue;
    const double weight = cotangent_weight(s, e);
    result.negative_cotangent_edges += weight < -zero_cotangent;
    result.zero_cotangent_edges += std::abs(weight) <= zero_cotangent;
  }
}

}  // namespace

void inspect_quality(const Surface& surface, Inspection& result) {
  if (has(result, DefectKind::non_finite_position)) return;
  measure_triangles(surface, result);
  count_cotangents(surface, result);
}

}  // namespace orbitutte::inspection
