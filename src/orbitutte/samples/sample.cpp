// SPDX-License-Identifier: MIT
// The figure and the mask are zero sets of smooth functions. Coarse meshes of them, set up by hand, grow into
// even ones. Projective planes have no inside, so they are made from parametrisations.
#include "orbitutte/samples/sample.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "orbitutte/samples/even_mesh.h"
#include "orbitutte/samples/projective_mesh.h"

namespace orbitutte {
namespace {

constexpr int fewest_faces = 100;
constexpr int fewest_projective_faces = 10;
constexpr int most_faces = 20'000'000;

// ---- the figure

// A limb: the hull of two balls.
struct Limb {
  Vector3 start, direction;
  double length, radius, slope;  // the radius grows by `slope` per length along the direction
  // How much further along the limb the nearest ball's centre lies, per distance from the axis.
  double lean;

  Limb(const Vector3& a, const Vector3& b, double radius_a, double radius_b)
      : start(a),
        direction((b - a).normalized()),
        length((b - a).norm()),
        radius(radius_a),
        slope((radius_b - radius_a) / length),
        lean(slope / std::sqrt(1 - slope * slope)) {}
};

const std::array<Limb, 12>& limbs() {
  static const std::array<Limb, 12> result = {{
      {{0, -0.12, 0}, {0, 0.34, 0}, 0.27, 0.19},              // trunk
      {{0, 0.45, 0}, {0, 0.70, 0}, 0.10, 0.12},               // neck
      {{0, 0.80, 0.02}, {0, 0.86, 0.02}, 0.27, 0.255},        // head
      {{0, 0.76, 0.31}, {0, 0.77, 0.32}, 0.06, 0.06},         // nose
      {{-0.20, 0.36, 0}, {-0.55, 0.22, 0.03}, 0.105, 0.095},  // right arm, hanging
      {{-0.55, 0.22, 0.03}, {-0.73, 0.00, 0.12}, 0.09, 0.11},
      {{0.20, 0.36, 0}, {0.52, 0.44, 0.02}, 0.105, 0.095},  // left arm, raised
      {{0.52, 0.44, 0.02}, {0.68, 0.72, 0.08}, 0.09, 0.11},
      {{-0.17, -0.22, 0}, {-0.25, -0.82, 0}, 0.15, 0.105},  // right leg and foot
      {{-0.25, -0.85, 0}, {-0.30, -0.87, 0.18}, 0.10, 0.09},
      {{0.17, -0.22, 0}, {0.25, -0.82, 0}, 0.15, 0.105},  // left leg and foot
      {{0.25, -0.85, 0}, {0.30, -0.87, 0.18}, 0.10, 0.09},
  }};
  return result;
}

// The distance to the hull of two balls: the least of |p - c(t)| - r(t) over the balls between them.
FieldSample limb_distance(const Limb& limb, const Vector3& p) {
  const Vector3 from_start = p - limb.start;
  const double along = from_start.dot(limb.direction);
  const double across = std::sqrt(std::max(0.0, from_start.squaredNorm() - along * along));
  const double t = std::clamp(along + across * limb.lean, 0.0, limb.length);
  const Vector3 from_centre = from_start - t * limb.direction;
  const double distance = from_centre.norm(), radius = limb.radius + t * limb.slope;
  if (distance == 0) return {-radius, Vector3::Zero()};
  return {distance - radius, from_centre / distance};
}

// -log(sum_i exp(-k d_i)) / k: the limbs' distances, smoothly joined over lengths of 1 / k.
FieldSample figure_field(const Vector3& p) {
  constexpr double sharpness = 14;
  constexpr double negligible = 1.5;  // exp(-k d) is 2e-10, too small a step to be seen
  std::array<FieldSample, 12> distance;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < distance.size(); ++i) {
    distance[i] = limb_distance(limbs()[i], p);
    least = std::min(least, distance[i].value);
  }
  double sum = 0;
  Vector3 gradient = Vector3::Zero();
  for (const FieldSample& d : distance) {
    if (d.value > least + negligible) continue;
    const double weight = std::exp(-sharpness * (d.value - least));
    sum += weight;
    gradient += weight * d.gradient;
  }
  return {least - std::log(sum) / sharpness, gradient / sum};
}

// A closed mesh of quadrilaterals that grows by pulling faces out.
struct Boxes {
  std::vector<Vector3> points;
  std::vector<std::array<int, 4>> faces;

  // Pulls a face out along `axis` to a square of the given half-diagonal around `centre`; this adds a ring of
  // four faces.
  void pull(int face, const Vector3& centre, const Vector3& axis, double radius) {
    const std::array<int, 4> old = faces[face];
    Vector3 middle = Vector3::Zero();
    for (const int v : old) middle += points[v] / 4;
    for (int k = 0; k < 4; ++k) {
      const Vector3 out = points[old[k]] - middle, d = axis.normalized();
      faces[face][k] = static_cast<int>(points.size());
      points.push_back(centre + radius * (out - out.dot(d) * d).normalized());
    }
    for (int k = 0; k < 4; ++k) {
      const int next = (k + 1) % 4;
      faces.push_back({old[k], old[next], faces[face][next], faces[face][k]});
    }
  }

  Mesh triangles() const {
    Mesh result;
    result.V.resize(static_cast<Eigen::Index>(points.size()), 3);
    for (std::size_t v = 0; v < points.size(); ++v) result.V.row(v) = points[v];
    result.F.resize(2 * static_cast<Eigen::Index>(faces.size()), 3);
    for (std::size_t f = 0; f < faces.size(); ++f) {
      const auto& [a, b, c, d] = faces[f];
      result.F.row(2 * f) << a, b, c;
      result.F.row(2 * f + 1) << a, c, d;
    }
    return result;
  }
};

// The trunk: a box of three columns and two rows. Below are a leg, nothing and a leg; above a shoulder, the
// neck and a shoulder. The upper row has the arms, the lower one the hips. The faces to be pulled out come
// first: the sides of the right and the left shoulder, the bottoms of the legs, the top of the middle.
Boxes trunk() {
  Boxes result;
  const auto vertex = [](int x, int y, int z) { return 6 * x + 2 * y + z; };
  for (const double x : {-0.28, -0.1, 0.1, 0.28}) {
    for (const double y : {-0.4, 0.15, 0.42}) {
      for (const double z : {-0.15, 0.15}) result.points.emplace_back(x, y, z);
    }
  }
  const auto right = [&](int y) {
    result.faces.push_back({vertex(0, y, 0), vertex(0, y, 1), vertex(0, y + 1, 1), vertex(0, y + 1, 0)});
  };
  const auto left = [&](int y) {
    result.faces.push_back({vertex(3, y, 0), vertex(3, y + 1, 0), vertex(3, y + 1, 1), vertex(3, y, 1)});
  };
  const auto bottom = [&](int x) {
    result.faces.push_back({vertex(x, 0, 0), vertex(x + 1, 0, 0), vertex(x + 1, 0, 1), vertex(x, 0, 1)});
  };
  const auto top = [&](int x) {
    result.faces.push_back({vertex(x, 2, 0), vertex(x, 2, 1), vertex(x + 1, 2, 1), vertex(x + 1, 2, 0)});
  };
  const auto front = [&](int x, int y) {
    result.faces.push_back(
        {vertex(x, y, 1), vertex(x + 1, y, 1), vertex(x + 1, y + 1, 1), vertex(x, y + 1, 1)});
  };
  const auto back = [&](int x, int y) {
    result.faces.push_back(
        {vertex(x, y, 0), vertex(x, y + 1, 0), vertex(x + 1, y + 1, 0), vertex(x + 1, y, 0)});
  };
  right(1), left(1), bottom(0), bottom(2), top(1);
  right(0), left(0), bottom(1), top(0), top(2);
  for (int x = 0; x < 3; ++x) {
    for (int y = 0; y < 2; ++y) front(x, y), back(x, y);
  }
  return result;
}

// The trunk with head, arms and legs pulled out: 62 quadrilaterals.
Mesh coarse_figure() {
  Boxes boxes = trunk();
  boxes.pull(0, {-0.55, 0.22, 0.03}, {-1, -1, 0.1}, 0.13);
  boxes.pull(0, {-0.78, -0.08, 0.14}, {-0.5, -1, 0.3}, 0.13);
  boxes.pull(1, {0.52, 0.44, 0.02}, {1, 0.8, 0.1}, 0.13);
  boxes.pull(1, {0.73, 0.80, 0.10}, {0.5, 1, 0.3}, 0.13);
  boxes.pull(2, {-0.21, -0.60, 0}, {0, -1, 0}, 0.14);
  boxes.pull(2, {-0.28, -0.93, 0.07}, {0, -1, 0}, 0.15);
  boxes.pull(3, {0.21, -0.60, 0}, {0, -1, 0}, 0.14);
  boxes.pull(3, {0.28, -0.93, 0.07}, {0, -1, 0}, 0.15);
  boxes.pull(4, {0, 0.56, 0}, {0, 1, 0}, 0.2);
  boxes.pull(4, {0, 1.0, 0.02}, {0, 1, 0}, 0.25);
  return boxes.triangles();
}

// ---- the mask

// A bell-shaped bump of the mask; its height is negative for a hollow.
struct Bump {
  Vector3 centre, size;
  double height;
};

const std::array<Bump, 16>& bumps() {
  static const std::array<Bump, 16> result = {{
      {{0, 0.02, 0.62}, {0.09, 0.24, 0.3}, 0.09},       // bridge of the nose
      {{0, -0.14, 0.68}, {0.10, 0.10, 0.2}, 0.13},      // its tip
      {{-0.10, -0.17, 0.62}, {0.08, 0.08, 0.2}, 0.03},  // its wings
      {{0.10, -0.17, 0.62}, {0.08, 0.08, 0.2}, 0.03},
      {{-0.27, 0.18, 0.5}, {0.18, 0.11, 0.3}, -0.10},  // sockets
      {{0.27, 0.18, 0.5}, {0.18, 0.11, 0.3}, -0.10},
      {{-0.26, 0.16, 0.5}, {0.11, 0.07, 0.3}, 0.06},  // eyes
      {{0.26, 0.16, 0.5}, {0.11, 0.07, 0.3}, 0.06},
      {{-0.27, 0.32, 0.5}, {0.20, 0.09, 0.3}, 0.045},  // brows
      {{0.27, 0.32, 0.5}, {0.20, 0.09, 0.3}, 0.045},
      {{-0.36, -0.15, 0.45}, {0.16, 0.16, 0.3}, 0.04},  // cheeks
      {{0.36, -0.15, 0.45}, {0.16, 0.16, 0.3}, 0.04},
      {{0, -0.42, 0.55}, {0.21, 0.06, 0.3}, 0.05},  // lips
      {{0, -0.57, 0.53}, {0.17, 0.065, 0.3}, 0.05},
      {{0, -0.69, 0.45}, {0.18, 0.08, 0.3}, -0.03},  // hollow under it
      {{0, -0.80, 0.38}, {0.17, 0.12, 0.3}, 0.06},   // chin
  }};
  return result;
}

// An ellipsoid with bumps: (|p / r| - 1) s - sum_i h_i exp(-|(p - c_i) / s_i|^2). The half in front of the
// plane z = 0 is the mask.
FieldSample mask_field(const Vector3& p) {
  const Vector3 radii(0.72, 1, 0.58);
  constexpr double scale = 0.6;
  const Vector3 q = p.cwiseQuotient(radii);
  FieldSample result = {scale * (q.norm() - 1), scale * q.normalized().cwiseQuotient(radii)};
  for (const Bump& bump : bumps()) {
    const Vector3 d = (p - bump.centre).cwiseQuotient(bump.size);
    const double height = bump.height * std::exp(-d.squaredNorm());
    result.value -= height;
    result.gradient += 2 * height * d.cwiseQuotient(bump.size);
  }
  return result;
}

// Six triangles around the middle.
Mesh coarse_mask() {
  Mesh result;
  result.V = Points::Zero(7, 3);
  result.F.resize(6, 3);
  result.V.row(0) << 0, 0, 0.6;
  for (int i = 0; i < 6; ++i) {
    const double angle = std::numbers::pi * i / 3;
    result.V.row(i + 1) << 0.72 * std::cos(angle), std::sin(angle), 0;
    result.F.row(i) << 0, i + 1, (i + 1) % 6 + 1;
  }
  return result;
}

// ---- all shapes

struct ShapeRow {
  SampleShape shape;
  EvenMap projective_map;  // of a projective plane; otherwise null
};

const std::array<ShapeRow, 6>& shapes() {
  static const std::array<ShapeRow, 6> result = {{{SampleShape::figure, nullptr},
                                                  {SampleShape::mask, nullptr},
                                                  {SampleShape::boy, boys_surface},
                                                  {SampleShape::roman, roman_surface},
                                                  {SampleShape::crosscap, cross_cap},
                                                  {SampleShape::quotient, limbed_quotient}}};
  return result;
}

const ShapeRow& row_of(SampleShape shape) {
  return *std::find_if(shapes().begin(), shapes().end(), [&](const ShapeRow& s) { return s.shape == shape; });
}

void require_faces_from(int fewest, int faces) {
  if (faces >= fewest && faces <= most_faces) return;
  throw ArgumentError(
      fmt::format("a sample mesh cannot have {} faces; ask for {} to {}", faces, fewest, most_faces));
}

// ---- cones

// The vertex that lies furthest in a direction.
int extreme_vertex(const Mesh& mesh, const Vector3& direction) {
  Eigen::Index vertex = 0;
  (mesh.V * direction).maxCoeff(&vertex);
  return static_cast<int>(vertex);
}

}  // namespace

bool passes_through_itself(SampleShape shape) { return row_of(shape).projective_map != nullptr; }

Mesh sample_mesh(const SampleOptions& options) {
  if (const EvenMap map = row_of(options.shape).projective_map) {
    require_faces_from(fewest_projective_faces, options.faces);
    return projective_mesh(map, options.faces);
  }
  require_faces_from(fewest_faces, options.faces);
  if (options.shape == SampleShape::figure) return even_mesh(coarse_figure(), {figure_field}, options.faces);
  return even_mesh(coarse_mask(), {mask_field}, options.faces);
}

std::vector<int> sample_cones(SampleShape shape, const Mesh& mesh) {
  if (row_of(shape).projective_map) return {extreme_vertex(mesh, {0, 0, 1})};
  if (shape == SampleShape::figure)
    return {extreme_vertex(mesh, {0, 1, 0.1}), extreme_vertex(mesh, {-0.5, -1, 0.3}),
            extreme_vertex(mesh, {1, 0.7, 0})};
  return {extreme_vertex(mesh, {0, 1, 0}), extreme_vertex(mesh, {-0.72, -0.6, 0}),
          extreme_vertex(mesh, {0.72, -0.6, 0}), extreme_vertex(mesh, {0, 0, 1})};
}

}  // namespace orbitutte
