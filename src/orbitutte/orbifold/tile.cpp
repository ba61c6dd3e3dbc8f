// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/tile.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "orbitutte/orbifold/families.h"
#include "orbitutte/orbifold/polygon.h"

namespace orbitutte {

TileSide geodesic_side(Space space, const Vector3& from, const Vector3& to, int mark) {
  TileSide side;
  side.space = space;
  side.start = from;
  side.direction = space.tangent(from, to - from);
  side.direction /= space.norm(side.direction);
  side.length = space.distance(from, to);
  side.mark = mark;
  return side;
}

Vector3 Tile::centroid() const {
  Vector3 sum = Vector3::Zero();
  for (const TileSide& side : sides)
    sum += space() == Space::sphere() ? Vector3(0.5 * side.length * side.line()) : side.start;
  return space().retract(sum);
}

namespace {

// Where the end of the cut stands in an arrangement of so many marks: after the first of them.
int end_of_cut(int marks) { return std::min(marks, 1); }

}  // namespace

Tile basic_tile(const Target& target, const std::vector<int>& arrangement) {
  if (!target.corners.empty()) return polygon_tile(target.corners, arrangement);
  if (target.has_free_tile)
    throw ArgumentError(
        fmt::format("the tile of {} has no shape of its own: it is the surface's, which is known "
                    "from an embedding alone",
                    target.signature));
  const Family& family = *find_family(target.symbol);
  const int marks = static_cast<int>(target.marks.size()), corners = marks + family.cut_to_mirror;
  if (static_cast<int>(arrangement.size()) < corners) throw ArgumentError("the arrangement leaves marks out");
  for (const int mark : arrangement)
    if (mark < 0 || mark >= corners || std::count(arrangement.begin(), arrangement.end(), mark) != 1)
      throw ArgumentError("the arrangement of the marks is no permutation of them");
  if (family.cut_to_mirror && (arrangement.front() != 0 || arrangement[end_of_cut(marks)] != marks))
    throw ArgumentError("the arrangement does not begin with the cone and the end of the cut");
  return family.tile(target, arrangement);
}

std::vector<int> first_arrangement(const Target& target) {
  std::vector<int> arrangement(target.marks.size());
  std::iota(arrangement.begin(), arrangement.end(), 0);
  if (target.corners.empty() && !target.has_free_tile && find_family(target.symbol)->cut_to_mirror)
    arrangement.insert(arrangement.begin() + end_of_cut(static_cast<int>(target.marks.size())),
                       static_cast<int>(target.marks.size()));
  return arrangement;
}

Tile moved_tile(const Tile& tile, const Isometry& isometry) {
  Tile result = tile;
  for (TileSide& side : result.sides) {
    side.start = isometry * side.start;
    side.direction = isometry * side.direction;
    side.transform = isometry * side.transform * isometry.inverse();
  }
  return result;
}

bool has_held_side(const Tile& tile) {
  return std::any_of(tile.sides.begin(), tile.sides.end(), [](const TileSide& side) { return side.held(); });
}

bool is_free_to_rotate(const Tile& tile) {
  Matrix3 turn;  // p -> (0, 0, 1) x p, the derivative of the rotation
  turn << 0, -1, 0, 1, 0, 0, 0, 0, 0;
  return std::all_of(tile.sides.begin(), tile.sides.end(), [&](const TileSide& side) {
    const Matrix3& g = side.transform.matrix();
    return !side.held() && (g * turn - turn * g).norm() < 1e-12;
  });
}

}  // namespace orbitutte
