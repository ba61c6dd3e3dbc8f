// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/polygon.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <unordered_set>

#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/tile.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

constexpr double corner_rounding = 1e-12;  // of positions on the unit sphere

using Corners = std::vector<PolygonCorner>;

const PolygonCorner& corner_after(const Corners& corners, std::size_t k) {
  return corners[(k + 1) % corners.size()];
}

// The sides' unit normals, towards the left.
std::vector<Vector3> poles(const Corners& corners) {
  std::vector<Vector3> result;
  for (std::size_t k = 0; k < corners.size(); ++k)
    result.push_back(corners[k].position.cross(corner_after(corners, k).position).normalized());
  return result;
}

// The angle by which the boundary turns left at every corner, in (-pi, pi]: pi less the interior angle.
std::vector<double> turns(const Corners& corners) {
  const std::vector<Vector3> pole = poles(corners);
  std::vector<double> result;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector3 &before = pole[(k + pole.size() - 1) % pole.size()], &after = pole[k];
    result.push_back(std::atan2(corners[k].position.dot(before.cross(after)), before.dot(after)));
  }
  return result;
}

// A direction in which all corners of a convex polygon lie: that of the integral of the position over it.
Vector3 middle(const Corners& corners) {
  Vector3 sum = Vector3::Zero();
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector3 &p = corners[k].position, &q = corner_after(corners, k).position, normal = p.cross(q);
    sum += std::atan2(normal.norm(), p.dot(q)) * normal.normalized();
  }
  return sum.normalized();
}

void require_distinct_unit_corners(const Corners& corners) {
  if (corners.size() < 3)
    throw MeshError(fmt::format("a polygon of {} corners has no inside; give three or more", corners.size()));
  std::unordered_set<int> seen;
  for (const PolygonCorner& corner : corners) {
    if (!seen.insert(corner.vertex).second)
      throw MeshError(fmt::format("vertex {} is two corners of the polygon; give it once", corner.vertex));
    if (!(std::abs(corner.position.norm() - 1) <= corner_rounding))
      throw MeshError(fmt::format("the corner at vertex {} is not on the unit sphere", corner.vertex));
  }
}

void require_sides(const Corners& corners) {
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const PolygonCorner &here = corners[k], &next = corner_after(corners, k);
    if ((here.position - next.position).norm() <= corner_rounding)
      throw MeshError(fmt::format("the corners at the vertices {} and {} are at the same point; move one",
                                  here.vertex, next.vertex));
    if ((here.position + next.position).norm() <= corner_rounding)
      throw MeshError(
          fmt::format("the corners at the vertices {} and {} are opposite points, which no side "
                      "joins; put a corner between them",
                      here.vertex, next.vertex));
  }
}

// The distances by which the corners' neighbours lie left of the sides through them, to first order: the
// turn times the shorter of both sides. Rounding of positions changes this by as much as the positions,
// however short the sides are.
std::vector<double> bends(const Corners& corners) {
  std::vector<double> result = turns(corners);
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector3 &here = corners[k].position, &next = corner_after(corners, k).position,
                  &last = corners[(k + corners.size() - 1) % corners.size()].position;
    result[k] *= std::min((next - here).norm(), (here - last).norm());
  }
  return result;
}

void require_left_turns(const Corners& corners) {
  const std::vector<double> bend = bends(corners);
  const PolygonCorner* right_turn = nullptr;
  bool turns_left = false;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    turns_left = turns_left || bend[k] > corner_rounding;
    if (bend[k] < -corner_rounding && !right_turn) right_turn = &corners[k];
  }
  if (!right_turn) return;
  if (turns_left)
    throw MeshError(
        fmt::format("the polygon is not convex: it turns right at the corner at vertex {}; move "
                    "that corner outwards or leave it out",
                    right_turn->vertex));
  throw MeshError(
      fmt::format("the polygon turns right at every corner, first at vertex {}: its corners run clockwise "
                  "seen from outside, or it is larger than a hemisphere; give them counterclockwise around a "
                  "smaller polygon",
                  right_turn->vertex));
}

void require_hemisphere(const Corners& corners) {
  const Vector3 up = middle(corners);
  for (const PolygonCorner& corner : corners)
    if (!(corner.position.dot(up) > corner_rounding))
      throw MeshError(
          fmt::format("the polygon fits into no open hemisphere: the corner at vertex {} is too far from its "
                      "middle; make it smaller than a hemisphere",
                      corner.vertex));
}

// A polygon that turns left everywhere is convex if it turns by 2 pi in all. Great arcs of an open
// hemisphere are straight in its central projection p/<p, up> onto a plane, where turns add up.
void require_one_round(const Corners& corners) {
  const Vector3 up = middle(corners);
  const auto projected = [&](const PolygonCorner& c) -> Vector3 { return c.position / c.position.dot(up); };
  const auto side = [&](std::size_t k) -> Vector3 {
    return projected(corner_after(corners, k)) - projected(corners[k % corners.size()]);
  };
  double turned = 0;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    const Vector3 before = side(k), after = side(k + 1);
    turned += std::atan2(up.dot(before.cross(after)), before.dot(after));
    if (turned > 2 * pi + 1e-6)
      throw MeshError(
          fmt::format("the polygon goes around more than once, from the corner at vertex {} on; "
                      "give its corners in their order around it",
                      corner_after(corners, k).vertex));
  }
}

Vector3 position_of(const ConeCopies& cone, const Points& positions) {
  if (cone.copies.size() != 1 || cone.copies[0] < 0 || cone.copies[0] >= positions.rows())
    throw MeshError(fmt::format("the corner at vertex {} is not one vertex of the cut mesh", cone.vertex));
  return positions.row(cone.copies[0]);
}

}  // namespace

Target polygon_target(const std::vector<PolygonCorner>& corners) {
  require_distinct_unit_corners(corners);
  require_sides(corners);
  require_left_turns(corners);
  require_hemisphere(corners);
  require_one_round(corners);
  Target polygon;
  polygon.signature = polygon_signature;
  polygon.topology = Topology::disk;
  polygon.marks.assign(corners.size(), Mark::of_order(1, ConeKind::fixed));
  polygon.corners = corners;
  return polygon;
}

std::vector<int> corner_vertices(const Target& polygon) {
  std::vector<int> vertices;
  for (const PolygonCorner& corner : polygon.corners) vertices.push_back(corner.vertex);
  return vertices;
}

Tile polygon_tile(const std::vector<PolygonCorner>& corners, const std::vector<int>& arrangement) {
  Tile tile;
  for (std::size_t k = 0; k < corners.size(); ++k) {
    if (k >= arrangement.size() || arrangement[k] != static_cast<int>(k))
      throw MeshError(
          fmt::format("the corner at vertex {} is not the next one along the boundary of the mesh, where the "
                      "polygon has it; give the corners in the order in which the boundary, its faces on the "
                      "left, meets their vertices",
                      corners[k].vertex));
    tile.sides.push_back(geodesic_side(Space::sphere(), corners[k].position,
                                       corner_after(corners, k).position, static_cast<int>(k)));
  }
  return tile;
}

namespace {

std::vector<Mark> marks_of_cones(const std::vector<ConeCopies>& cones) {
  std::vector<Mark> marks;
  marks.reserve(cones.size());
  for (const ConeCopies& cone : cones) marks.push_back(cone.mark);
  return marks;
}

}  // namespace

Target read_target(const std::string& signature, const std::vector<ConeCopies>& cones,
                   const Points& positions) {
  if (signature == cones_signature) return cone_target(Topology::sphere, marks_of_cones(cones));
  if (signature == mirrored_cones_signature) return cone_target(Topology::disk, marks_of_cones(cones));
  if (signature != polygon_signature) return parse_orbifold(signature);
  Corners corners;
  for (const ConeCopies& cone : cones) corners.push_back({cone.vertex, position_of(cone, positions)});
  return polygon_target(corners);
}

namespace {

// Of a plane polygon: half the sum of the cross products of neighbouring corners.
double plane_area(const Tile& tile) {
  double twice = 0;
  for (std::size_t k = 0; k < tile.sides.size(); ++k)
    twice += tile.sides[k].start.cross(tile.sides[(k + 1) % tile.sides.size()].start).z();
  return twice / 2;
}

}  // namespace

double target_area(const Target& target) {
  if (target.has_free_tile) return free_tile_area(target);
  if (target.space == Space::plane()) return plane_area(basic_tile(target, first_arrangement(target)));
  if (target.corners.empty()) return 4 * pi / target.group_order;
  double area = 2 * pi;
  for (const double turn : turns(target.corners)) area -= turn;
  return area;
}

}  // namespace orbitutte
