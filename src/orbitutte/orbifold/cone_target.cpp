// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/cone_target.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

#include "orbitutte/orbifold/target_words.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

constexpr double angle_rounding = 1e-9;  // of angles that were typed or computed

// 2 pi chi.
double curvature_without_marks(Topology topology) { return topology == Topology::sphere ? 4 * pi : 2 * pi; }

// The angle of an ordinary point.
double flat_angle(const Mark& mark) { return mark.kind == ConeKind::corner ? pi : 2 * pi; }

void check_cone_topology(Topology topology) {
  if (topology != Topology::sphere && topology != Topology::disk)
    throw ArgumentError(
        fmt::format("cones of any angles need a sphere or a disk, not a {}", text_of(topology)));
}

void check_cone_marks(Topology topology, const std::vector<Mark>& marks) {
  bool is_after_corner = false;
  for (std::size_t k = 0; k < marks.size(); ++k) {
    const auto& [angle, kind] = marks[k];
    if (!(angle > 0) || !std::isfinite(angle))
      throw ArgumentError(fmt::format("the angle of mark {} is {}; angles are positive", k, angle));
    if (kind == ConeKind::fixed) throw ArgumentError(fmt::format("mark {} is neither cone nor corner", k));
    if (kind == ConeKind::corner && topology == Topology::sphere)
      throw ArgumentError(fmt::format("mark {} is a corner, which a sphere does not have", k));
    if (kind == ConeKind::rotation && is_after_corner)
      throw ArgumentError(fmt::format("mark {} is a cone after a corner; the cones come first", k));
    is_after_corner = kind == ConeKind::corner;
  }
}

// Takes the rounding of flat angles away, the same part from each.
void make_angles_flat(double curvature, std::vector<Mark>& marks) {
  for (Mark& mark : marks) mark.angle -= curvature / static_cast<double>(marks.size());
}

Space space_of_curvature(double curvature) {
  if (curvature > 0) return Space::sphere();
  return curvature == 0 ? Space::plane() : Space::hyperbolic_plane();
}

}  // namespace

bool takes_angles(const std::string& signature) {
  return signature == cones_signature || signature == mirrored_cones_signature;
}

Topology topology_of_cones(const std::string& signature) {
  return signature == cones_signature ? Topology::sphere : Topology::disk;
}

double total_curvature(Topology topology, const std::vector<Mark>& marks) {
  double curvature = curvature_without_marks(topology);
  for (const Mark& mark : marks) curvature -= flat_angle(mark) - mark.angle;
  return curvature;
}

Target cone_target(Topology topology, std::vector<Mark> marks) {
  check_cone_topology(topology);
  check_cone_marks(topology, marks);
  double curvature = total_curvature(topology, marks);
  if (std::abs(curvature) <= angle_rounding) {
    make_angles_flat(curvature, marks);
    curvature = 0;
  }
  Target target;
  target.signature = topology == Topology::sphere ? cones_signature : mirrored_cones_signature;
  target.space = space_of_curvature(curvature);
  target.topology = topology;
  for (const Mark& mark : marks) target.inner_marks += mark.kind == ConeKind::rotation;
  target.marks = std::move(marks);
  target.group_order = 0;
  target.has_free_tile = true;
  return target;
}

double free_tile_area(const Target& target) {
  if (target.space == Space::plane()) return target.topology == Topology::sphere ? 2 : 1;
  return target.space.curvature() * total_curvature(target.topology, target.marks);
}

int turns_in_excess(const Mark& mark) {
  constexpr double slack = 1e-9;
  return static_cast<int>(std::ceil(mark.angle / flat_angle(mark) - slack)) - 1;
}

}  // namespace orbitutte
