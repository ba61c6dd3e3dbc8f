// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/tile.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "orbitutte/orbifold/families.h"
#include "orbitutte/orbifold/polygon.h"

namespace orbitutte {

Vector3 TileSide::point(double s) const {
  if (geometry == Geometry::euclidean) return start + s * direction;
  return std::cos(s) * start + std::sin(s) * direction;
}

TileSide great_arc(const Vector3& from, const Vector3& to, int mark) {
  const Vector3 across = from.cross(to);
  TileSide side;
  side.start = from;
  side.direction = across.cross(from).normalized();
  side.length = std::atan2(across.norm(), from.dot(to));
  side.mark = mark;
  return side;
}

Vector3 Tile::centroid() const {
  Vector3 sum = Vector3::Zero();
  for (const TileSide& side : sides) sum += 0.5 * side.length * side.pole();
  return sum.normalized();
}

Tile basic_tile(const Orbifold& orbifold, const std::vector<int>& arrangement) {
  if (!orbifold.corners.empty()) return polygon_tile(orbifold.corners, arrangement);
  const Family& family = *find_family(orbifold.symbol, orbifold.geometry);
  const int marks = static_cast<int>(orbifold.marks.size()), corners = marks + family.cut_to_mirror;
  std::vector<int> orders;
  for (const int mark : arrangement) {
    if (mark < 0 || mark >= corners || std::count(arrangement.begin(), arrangement.end(), mark) != 1)
      throw ArgumentError("the arrangement of the marks is no permutation of them");
    orders.push_back(mark < marks ? orbifold.marks[mark].order : 1);
  }
  if (static_cast<int>(arrangement.size()) != corners)
    throw ArgumentError("the arrangement leaves marks out");
  if (family.cut_to_mirror && (arrangement[0] != 0 || arrangement[1] != marks))
    throw ArgumentError("the arrangement does not begin with the cone and the end of the cut");
  return family.tile(orders, arrangement);
}

Tile rotated(const Tile& tile, const Matrix3& rotation) {
  Tile result = tile;
  for (TileSide& side : result.sides) {
    side.start = rotation * side.start;
    side.direction = rotation * side.direction;
    side.transform = rotation * side.transform * rotation.transpose();
  }
  return result;
}

bool stays_put(const Tile& tile) {
  return std::any_of(tile.sides.begin(), tile.sides.end(), [](const TileSide& side) { return side.held(); });
}

bool free_rotation_axis(const Tile& tile, Vector3& axis) {
  axis = tile.sides.front().start;
  Matrix3 turn;  // p -> axis x p, the derivative of the rotation
  turn << 0, -axis.z(), axis.y(), axis.z(), 0, -axis.x(), -axis.y(), axis.x(), 0;
  return std::all_of(tile.sides.begin(), tile.sides.end(), [&](const TileSide& side) {
    return !side.held() && (side.transform * turn - turn * side.transform).norm() < 1e-12 &&
           std::abs(std::abs(side.start.dot(axis)) - 1) < 1e-12;
  });
}

}  // namespace orbitutte
