// SPDX-License-Identifier: MIT
// Areas, angles and lengths of the faces, cotangents of the triangles.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>
#include <numbers>

#include "orbitutte/inspect/inspection_steps.h"

namespace orbitutte::inspection {
namespace {

constexpr double zero_cotangent = 1e-12;  // rounding errors of a right angle, many times over

// A face with the largest coordinate of its edges as the unit, so that nothing overflows.
class Outline {
 public:
  Outline(const PolygonMesh& mesh, int f)
      : mesh_(mesh), first_(mesh.face_start[f]), degree_(mesh.face_degree(f)) {
    for (int k = 0; k < degree_; ++k) unit_ = std::max(unit_, side(k).lpNorm<Eigen::Infinity>());
    Vector3 from_first = edge(0);  // to corner k
    for (int k = 1; k + 1 < degree_; ++k) {
      normal_ += from_first.cross(edge(k));
      from_first += edge(k);
    }
  }

  int degree() const { return degree_; }
  double length(int k) const { return edge(k).norm() * unit_; }
  double area() const { return 0.5 * normal_.norm() * unit_ * unit_; }
  bool has_area() const { return normal_.norm() > 8 * std::numeric_limits<double>::epsilon(); }

  // Between the edges at a corner, on the inner side.
  double angle(int corner) const {
    const Vector3 out = edge(corner), in = -edge(before(corner)), across = out.cross(in);
    const double angle = std::atan2(across.norm(), out.dot(in));
    return across.dot(normal_) < 0 ? 2 * std::numbers::pi - angle : angle;
  }

  // Of the angle at a corner; zero if the face has no area.
  double cotangent(int corner) const {
    const Vector3 out = edge(corner), in = -edge(before(corner));
    const double cotangent = out.dot(in) / out.cross(in).norm();
    return std::isfinite(cotangent) ? cotangent : 0.0;
  }

 private:
  int before(int corner) const { return (corner + degree_ - 1) % degree_; }

  // From corner k to the next.
  Vector3 side(int k) const {
    const int* corner = &mesh_.corners[first_];
    return mesh_.V.row(corner[(k + 1) % degree_]) - mesh_.V.row(corner[k]);
  }
  Vector3 edge(int k) const { return side(k) / unit_; }

  const PolygonMesh& mesh_;
  int first_, degree_;
  double unit_ = 0;
  Vector3 normal_ = Vector3::Zero();  // twice the vector area over the square of the unit
};

bool is_triangle(const InspectedMesh& s, int f) { return s.well_formed(f) && s.mesh.face_degree(f) == 3; }

void measure_faces(const InspectedMesh& s, Inspection& result) {
  double min_angle = std::numeric_limits<double>::infinity(), min_edge = min_angle;
  for (int f = 0; f < result.faces; ++f) {
    if (!s.well_formed(f)) continue;
    const Outline face(s.mesh, f);
    if (!face.has_area()) {
      ++result.zero_area_faces;
      continue;
    }
    result.area += face.area();
    for (int k = 0; k < face.degree(); ++k) {
      min_angle = std::min(min_angle, face.angle(k));
      result.max_angle = std::max(result.max_angle, face.angle(k));
      min_edge = std::min(min_edge, face.length(k));
      result.max_edge_length = std::max(result.max_edge_length, face.length(k));
    }
  }
  if (result.max_angle > 0) result.min_angle = min_angle, result.min_edge_length = min_edge;
}

// Angles and the distortion of a map mean nothing on such a mesh.
void report_missing_area(const PolygonMesh& mesh, Inspection& result) {
  if (result.zero_area_faces < result.faces) return;
  const bool one_point = (mesh.V.rowwise() - mesh.V.row(0)).cwiseAbs().maxCoeff() == 0;
  add(result, DefectKind::no_area, result.faces,
      fmt::format("no face has any area{}; give the vertices their positions",
                  one_point ? ", since all vertices are at the same point" : ""));
  result.topology = Topology::other;
}

// w_ij = (cot a + cot b)/2 over the angles opposite to the edge.
double cotangent_weight(const InspectedMesh& s, int e) {
  double weight = 0;
  for (int i = 0; i < s.faces_on(e); ++i) {
    const int h = s.half_edge(e, i), f = s.face_of[h];
    const int opposite = (h - s.mesh.face_start[f] + 2) % 3;
    weight += 0.5 * Outline(s.mesh, f).cotangent(opposite);
  }
  return weight;
}

void count_cotangents(const InspectedMesh& s, Inspection& result) {
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

void inspect_quality(const InspectedMesh& inspected, Inspection& result) {
  if (has(result, DefectKind::non_finite_position) || has(result, DefectKind::size_out_of_range)) return;
  measure_faces(inspected, result);
  report_missing_area(inspected.mesh, result);
  count_cotangents(inspected, result);
}

}  // namespace orbitutte::inspection
