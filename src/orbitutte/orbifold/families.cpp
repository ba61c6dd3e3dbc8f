// SPDX-License-Identifier: MIT
// Tiles after Aigerman, Kovalsky, Lipman, appendix A, with the corrections listed in docs/deviations.md.
#include "orbitutte/orbifold/families.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace orbitutte {
namespace {

using std::numbers::pi;

Matrix3 rotation(const Vector3& axis, double angle) {
  return Eigen::AngleAxisd(angle, axis).toRotationMatrix();
}

Matrix3 reflection(const Vector3& normal) { return Matrix3::Identity() - 2 * normal * normal.transpose(); }

// The side opposite to the angle a of a spherical triangle with angles a, b, c: the law of cosines for
// angles.
double opposite_side(double a, double b, double c) {
  return std::acos((std::cos(a) + std::cos(b) * std::cos(c)) / (std::sin(b) * std::sin(c)));
}

// The corners p1, p2, p3 of the triangle with angles pi/n1, pi/n2, pi/n3, counterclockwise from outside, p1
// at the north pole.
std::vector<Vector3> triangle_corners(const std::vector<int>& n) {
  const double a1 = pi / n[0], a2 = pi / n[1], a3 = pi / n[2];
  const double p1p2 = opposite_side(a3, a1, a2), p1p3 = opposite_side(a2, a3, a1);
  const auto at = [](double colatitude, double longitude) {
    return Vector3(std::sin(colatitude) * std::cos(longitude), std::sin(colatitude) * std::sin(longitude),
                   std::cos(colatitude));
  };
  return {Vector3::UnitZ(), at(p1p2, 0), at(p1p3, a1)};
}

// The shorter great arc between two points that are not antipodal.
TileSide short_arc(const Vector3& from, const Vector3& to, int mark) {
  const Vector3 across = from.cross(to);
  TileSide side;
  side.start = from;
  side.direction = across.cross(from).normalized();
  side.length = std::atan2(across.norm(), from.dot(to));
  side.mark = mark;
  return side;
}

// The half circle between the poles along a meridian.
TileSide meridian(const Vector3& from, double longitude, int mark) {
  TileSide side;
  side.start = from;
  side.direction = Vector3(std::cos(longitude), std::sin(longitude), 0);
  side.length = pi;
  side.mark = mark;
  return side;
}

void make_mirror(Tile& tile, int side) {
  tile.sides[side].partner = side;
  tile.sides[side].transform = reflection(tile.sides[side].pole());
}

void make_mirrors(Tile& tile) {
  for (int k = 0; k < static_cast<int>(tile.sides.size()); ++k) make_mirror(tile, k);
}

void glue_sides(Tile& tile, int left, int right, const Matrix3& transform) {
  tile.sides[left].partner = right;
  tile.sides[left].transform = transform;
  tile.sides[right].partner = left;
  tile.sides[right].transform = transform.transpose();
}

// *n1 n2 n3: the triangle with three mirrors.
Tile mirrored_triangle(const std::vector<int>& n, const std::vector<int>& marks) {
  const std::vector<Vector3> p = triangle_corners(n);
  Tile tile;
  for (int k = 0; k < 3; ++k) tile.sides.push_back(short_arc(p[k], p[(k + 1) % 3], marks[k]));
  make_mirrors(tile);
  return tile;
}

// The triangle and its mirror image across the side p1 p3: p1, p2, p3 and the image of p2, no side glued yet.
Tile kite(const std::vector<int>& n, const std::vector<int>& marks) {
  const std::vector<Vector3> p = triangle_corners({n[0], n[2], n[1]});  // p1, p3, p2'
  const Vector3 &p1 = p[0], &p3 = p[1], &p2_image = p[2];
  const Vector3 p2 = reflection(p1.cross(p3).normalized()) * p2_image;
  Tile tile;
  tile.sides = {short_arc(p1, p2, marks[0]), short_arc(p2, p3, marks[1]), short_arc(p3, p2_image, marks[2]),
                short_arc(p2_image, p1, marks[1])};
  return tile;
}

// n1 n2 n3: the kite, glued by rotations about p1 and p3.
Tile doubled_triangle(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = kite(n, marks);
  const Vector3 p1 = tile.sides[0].start, p3 = tile.sides[2].start;
  glue_sides(tile, 0, 3, rotation(p1, -2 * pi / n[0]));
  glue_sides(tile, 2, 1, rotation(p3, -2 * pi / n[2]));
  return tile;
}

// n*m: the kite, cut open from the cone p1 to any point p2 of the mirror, where its angles are right; from
// there one mirror leads to the corner p3, and one from the corner to the image of p2.
Tile mirrored_kite(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = kite({n[0], 2, 2 * n[2]}, marks);
  glue_sides(tile, 0, 3, rotation(tile.sides[0].start, -2 * pi / n[0]));
  for (const int k : {1, 2}) make_mirror(tile, k);
  tile.sides[1].slides = tile.sides[3].slides = true;
  return tile;
}

// N*: a sector of the hemisphere, cut open from the pole to any point of the equator, the mirror. To hold
// that point only chooses one of all rotations about the axis, which change nothing.
Tile sector(const std::vector<int>& n, const std::vector<int>& marks) {
  const double angle = 2 * pi / n[0];
  const Vector3 pole = Vector3::UnitZ(), start = Vector3::UnitX(), end = rotation(pole, angle) * start;
  TileSide equator = short_arc(start, Vector3::UnitY(), marks[1]);
  equator.length = angle;
  Tile tile;
  tile.sides = {short_arc(pole, start, marks[0]), equator, short_arc(end, pole, marks[1])};
  glue_sides(tile, 0, 2, rotation(pole, -angle));
  make_mirror(tile, 1);
  return tile;
}

// The lune of the given angle: down the meridian of longitude 0, up that of longitude `angle`.
Tile lune(double angle, const std::vector<int>& marks) {
  Tile tile;
  tile.sides = {meridian(Vector3::UnitZ(), 0, marks[0]), meridian(-Vector3::UnitZ(), angle, marks[1])};
  return tile;
}

Tile glued_lune(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = lune(2 * pi / n[0], marks);
  glue_sides(tile, 0, 1, rotation(Vector3::UnitZ(), -2 * pi / n[0]));
  return tile;
}

Tile mirrored_lune(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = lune(pi / n[0], marks);
  make_mirrors(tile);
  return tile;
}

// Nx: a lune, cut open along a loop from the cone to itself, which becomes two meridians from a pole to the
// other; the rotary reflection takes one to the other and exchanges the poles.
Tile crossed_lune(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = lune(pi / n[0], {marks[0], marks[0]});
  glue_sides(tile, 0, 1, reflection(Vector3::UnitZ()) * rotation(Vector3::UnitZ(), -pi / n[0]));
  return tile;
}

constexpr int N = 0;  // the free order in a pattern

ConwaySymbol rotations(std::vector<int> orders) { return {std::move(orders), {}, false, false}; }
ConwaySymbol corners(std::vector<int> orders) { return {{}, std::move(orders), true, false}; }
ConwaySymbol mixed(int rotation, std::vector<int> corners) {
  return {{rotation}, std::move(corners), true, false};
}

ConwaySymbol crossed(int rotation) { return {{rotation}, {}, false, true}; }

const std::string three_vertices = "three vertices, in the order of the digits";
const std::string two_vertices = "two vertices";
const std::string three_boundary_vertices = "three boundary vertices, in the order of the digits";
const std::string two_boundary_vertices = "two boundary vertices";
const std::string vertex_on_each_side = "one inside, of the order before the star, then one on the boundary";
const std::string one_vertex_inside = "one vertex inside";
const std::string one_vertex = "one vertex";

}  // namespace

const std::vector<Family>& family_table() {
  static const std::vector<Family> table = {
      {"532", "60", three_vertices, rotations({2, 3, 5}), Topology::sphere, doubled_triangle},
      {"432", "24", three_vertices, rotations({2, 3, 4}), Topology::sphere, doubled_triangle},
      {"332", "12", three_vertices, rotations({2, 3, 3}), Topology::sphere, doubled_triangle},
      {"22N", "2N", three_vertices, rotations({2, 2, N}), Topology::sphere, doubled_triangle},
      {"NN", "N", two_vertices, rotations({N, N}), Topology::sphere, glued_lune},
      {"*532", "120", three_boundary_vertices, corners({2, 3, 5}), Topology::disk, mirrored_triangle},
      {"*432", "48", three_boundary_vertices, corners({2, 3, 4}), Topology::disk, mirrored_triangle},
      {"*332", "24", three_boundary_vertices, corners({2, 3, 3}), Topology::disk, mirrored_triangle},
      {"*22N", "4N", three_boundary_vertices, corners({2, 2, N}), Topology::disk, mirrored_triangle},
      {"*NN", "2N", two_boundary_vertices, corners({N, N}), Topology::disk, mirrored_lune},
      {"3*2", "24", vertex_on_each_side, mixed(3, {2}), Topology::disk, mirrored_kite, true},
      {"2*N", "4N", vertex_on_each_side, mixed(2, {N}), Topology::disk, mirrored_kite, true},
      {"N*", "2N", one_vertex_inside, mixed(N, {}), Topology::disk, sector, true},
      {"Nx", "2N", one_vertex, crossed(N), Topology::projective_plane, crossed_lune, false, 1},
  };
  return table;
}

namespace {

// Do the orders fit the pattern, every N standing for the same number, `smallest` or more?
bool fits(std::vector<int> orders, const std::vector<int>& pattern, int smallest) {
  if (orders.size() != pattern.size()) return false;
  for (const int fixed : pattern) {
    if (fixed == N) continue;
    const auto at = std::find(orders.begin(), orders.end(), fixed);
    if (at == orders.end()) return false;
    orders.erase(at);
  }
  return std::adjacent_find(orders.begin(), orders.end(), std::not_equal_to<>()) == orders.end() &&
         std::all_of(orders.begin(), orders.end(), [&](int n) { return n >= smallest; });
}

}  // namespace

const Family* find_family(const ConwaySymbol& symbol) {
  for (const Family& family : family_table()) {
    if (symbol.star == family.pattern.star && symbol.cross == family.pattern.cross &&
        fits(symbol.rotations, family.pattern.rotations, family.smallest_order) &&
        fits(symbol.corners, family.pattern.corners, family.smallest_order))
      return &family;
  }
  return nullptr;
}

}  // namespace orbitutte
