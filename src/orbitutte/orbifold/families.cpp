// SPDX-License-Identifier: MIT
// Tiles after Aigerman, Kovalsky, Lipman, appendix A, with the corrections listed in docs/deviations.md.
#include "orbitutte/orbifold/families.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace orbitutte {
namespace {

using std::numbers::pi;

using Arrangement = std::vector<int>;  // of the marks, as the boundary meets them

// The orders of all marks, followed by that of the end of a cut.
std::vector<int> orders_of(const Target& target) {
  std::vector<int> orders;
  for (const Mark& mark : target.marks) orders.push_back(mark.order());
  orders.push_back(1);
  return orders;
}

// The triangle with the angle pi/n[k] at corner k, counterclockwise from outside: corner 0 at (0, 0, 1),
// corner 1 from there in the direction of x.
std::array<Vector3, 3> canonical_triangle(Space space, const std::array<int, 3>& n) {
  const double a = pi / n[0], b = pi / n[1], c = pi / n[2];
  return {Space::origin(), space.polar(space.side_opposite(c, a, b), 0),
          space.polar(space.side_opposite(b, c, a), a)};
}

// Does the arrangement of three marks go around like 0, 1, 2?
bool goes_around(const Arrangement& marks) { return (marks[1] - marks[0] + 3) % 3 == 1; }

void make_mirror(Tile& tile, int side) {
  tile.sides[side].partner = side;
  tile.sides[side].transform = tile.space().reflection(tile.sides[side].line());
}

void make_mirrors(Tile& tile) {
  for (int k = 0; k < static_cast<int>(tile.sides.size()); ++k) make_mirror(tile, k);
}

void glue_sides(Tile& tile, int left, int right, const Isometry& transform) {
  tile.sides[left].partner = right;
  tile.sides[left].transform = transform;
  tile.sides[right].partner = left;
  tile.sides[right].transform = transform.inverse();
}

// The polygon with these corners, no side glued yet.
Tile polygon(Space space, const std::vector<Vector3>& corners, const std::vector<int>& marks) {
  Tile tile;
  for (std::size_t k = 0; k < corners.size(); ++k)
    tile.sides.push_back(geodesic_side(space, corners[k], corners[(k + 1) % corners.size()], marks[k]));
  return tile;
}

// *n1 n2 n3: the triangle with three mirrors; its mirror image if the boundary meets the marks the other way
// around.
Tile mirrored_triangle(const Target& target, const Arrangement& marks) {
  const std::vector<int> n = orders_of(target);
  std::array<Vector3, 3> corners = canonical_triangle(target.space, {n[0], n[1], n[2]});
  if (!goes_around(marks)) corners[2].y() = -corners[2].y();
  Tile tile = polygon(target.space, {corners[marks[0]], corners[marks[1]], corners[marks[2]]}, marks);
  make_mirrors(tile);
  return tile;
}

// The canonical triangle, with corner k at mark k, and its mirror image across the side between the first
// mark and the third, p1 and p3, as the boundary meets them: p1, p2, p3, p2', no side glued yet. Whichever
// mark is the second, the tile is made of the same two triangles of the tiling.
Tile kite(Space space, const std::array<Vector3, 3>& corners, const Arrangement& marks) {
  const Vector3 &p1 = corners[marks[0]], &p3 = corners[marks[2]], &p2 = corners[marks[1]];
  const Vector3 image = space.retract(space.reflection(Space::line(p1, p3)) * p2);
  const bool is_first = goes_around(marks);
  return polygon(space, {p1, is_first ? p2 : image, p3, is_first ? image : p2},
                 {marks[0], marks[1], marks[2], marks[1]});
}

// n1 n2 n3: the kite, glued by rotations about p1 and p3.
Tile doubled_triangle(const Target& target, const Arrangement& marks) {
  const std::vector<int> n = orders_of(target);
  Tile tile = kite(target.space, canonical_triangle(target.space, {n[0], n[1], n[2]}), marks);
  const Vector3 p1 = tile.sides[0].start, p3 = tile.sides[2].start;
  glue_sides(tile, 0, 3, target.space.rotation(p1, -2 * pi / n[marks[0]]));
  glue_sides(tile, 2, 1, target.space.rotation(p3, -2 * pi / n[marks[2]]));
  return tile;
}

// n*m: the kite over the triangle of the cone, the corner and the end of the cut, any point p2 of the mirror,
// where its angles are right. It is cut open from the cone p1 to p2; from there one mirror leads to the
// corner p3, and one from the corner to the image of p2.
Tile mirrored_kite(const Target& target, const Arrangement& marks) {
  const std::vector<int> n = orders_of(target);
  Tile tile = kite(target.space, canonical_triangle(target.space, {n[0], 2 * n[1], 2}), marks);
  glue_sides(tile, 0, 3, target.space.rotation(tile.sides[0].start, -2 * pi / n[0]));
  for (const int k : {1, 2}) make_mirror(tile, k);
  tile.sides[1].slides = tile.sides[3].slides = true;
  return tile;
}

// A side of the sphere that may be longer than a quarter of a great circle.
TileSide arc(const Vector3& from, const Vector3& direction, double length, int mark) {
  TileSide side;
  side.start = from;
  side.direction = direction;
  side.length = length;
  side.mark = mark;
  return side;
}

// N*: a sector of the hemisphere, cut open from the pole to any point of the equator, the mirror. Holding
// that point only chooses one of all rotations about the axis, which change nothing.
Tile sector(const Target& target, const Arrangement& marks) {
  const double angle = target.marks[0].angle;
  const Vector3 pole = Vector3::UnitZ(), start = Vector3::UnitX(), end = target.space.polar(pi / 2, angle);
  Tile tile;
  tile.sides = {geodesic_side(target.space, pole, start, marks[0]),
                arc(start, Vector3::UnitY(), angle, marks[1]),
                geodesic_side(target.space, end, pole, marks[1])};
  glue_sides(tile, 0, 2, target.space.rotation(pole, -angle));
  make_mirror(tile, 1);
  return tile;
}

// The side of a lune that leads down, from the north pole: the first, unless the boundary meets mark 1 first.
int down_side(const Arrangement& marks) { return marks[0] == 0 ? 0 : 1; }

// The lune of the given angle with mark 0 at the north pole. It leads down the meridian of longitude 0 and
// up that of longitude `angle`, and begins at the mark that the boundary meets first.
Tile lune(double angle, const Arrangement& marks) {
  const auto meridian = [](const Vector3& from, double longitude, int mark) {
    return arc(from, {std::cos(longitude), std::sin(longitude), 0}, pi, mark);
  };
  const int down = down_side(marks), up = 1 - down;
  Tile tile;
  tile.sides.resize(2);
  tile.sides[down] = meridian(Vector3::UnitZ(), 0, marks[down]);
  tile.sides[up] = meridian(-Vector3::UnitZ(), angle, marks[up]);
  return tile;
}

Tile glued_lune(const Target& target, const Arrangement& marks) {
  const double angle = target.marks[0].angle;
  Tile tile = lune(angle, marks);
  const int down = down_side(marks);
  glue_sides(tile, down, 1 - down, target.space.rotation(Vector3::UnitZ(), -angle));
  return tile;
}

Tile mirrored_lune(const Target& target, const Arrangement& marks) {
  Tile tile = lune(target.marks[0].angle, marks);
  make_mirrors(tile);
  return tile;
}

// Nx: a lune, cut open along a loop from the cone to itself, which becomes two meridians from a pole to the
// other; the rotary reflection takes one to the other and exchanges the poles.
Tile crossed_lune(const Target& target, const Arrangement& marks) {
  const double angle = target.marks[0].angle / 2;
  Tile tile = lune(angle, {marks[0], marks[0]});
  const Isometry across = target.space.reflection(Vector3::UnitZ());
  glue_sides(tile, 0, 1, across * target.space.rotation(Vector3::UnitZ(), -angle));
  return tile;
}

// 1: the whole sphere, which has no side.
Tile whole_sphere(const Target& /*target*/, const Arrangement& /*marks*/) { return {}; }

// *: the upper hemisphere. Its mirror, the equator, begins at any of its points.
Tile hemisphere(const Target& /*target*/, const Arrangement& marks) {
  Tile tile;
  tile.sides = {arc(Vector3::UnitX(), Vector3::UnitY(), 2 * pi, marks[0])};
  make_mirror(tile, 0);
  tile.sides[0].slides = true;
  return tile;
}

// Chambers (Family::chamber).

std::vector<int> triangle_of_marks(const Target& target) {
  return {target.marks[0].order(), target.marks[1].order(), target.marks[2].order()};
}

// n*m: half the kite.
std::vector<int> triangle_at_mirror(const Target& target) {
  return {target.marks[0].order(), 2 * target.marks[1].order(), 2};
}

// Between the meridians of longitude 0 and pi/2N and the equator: for N about one axis.
std::vector<int> triangle_at_equator(const Target& target) { return {2 * target.marks[0].order(), 2, 2}; }

// Between the three planes of coordinates: for the groups of no rotation.
std::vector<int> octant(const Target& /*target*/) { return {2, 2, 2}; }

constexpr int N = 0;  // the free order in a pattern

ConwaySymbol rotations(std::vector<int> orders) { return {std::move(orders), {}, false, false}; }
ConwaySymbol corners(std::vector<int> orders) { return {{}, std::move(orders), true, false}; }
ConwaySymbol mixed(int rotation, std::vector<int> corners) {
  return {{rotation}, std::move(corners), true, false};
}

ConwaySymbol crossed(int rotation) { return {{rotation}, {}, false, true}; }

const ConwaySymbol nothing_marked;
const ConwaySymbol mirror_alone = {{}, {}, true, false};

Family about_one_axis(Family family) {
  family.has_one_axis = true;
  return family;
}

Family filling(const PartOfCell& part, Family family) {
  family.part_of_cell = part;
  return family;
}

constexpr PartOfCell quarter_at_order_4 = {0.5, 0.5, 4}, quarter_at_order_2 = {0.5, 0.5, 2},
                     half_at_order_2 = {0.5, 1, 2};

const std::string infinite = "infinite";
const std::string none_marked = "none";
const std::string three_vertices = "three vertices, in the order of the digits";
const std::string four_vertices = "four vertices";
const std::string two_vertices = "two vertices";
const std::string three_boundary_vertices = "three boundary vertices, in the order of the digits";
const std::string four_boundary_vertices = "four boundary vertices, in the order in which they go around";
const std::string two_boundary_vertices = "two boundary vertices";
const std::string vertex_on_each_side =
    "one vertex inside (first order), then one on the boundary (second order)";
const std::string one_vertex_inside = "one vertex inside";
const std::string one_vertex = "one vertex";

}  // namespace

const std::vector<Family>& family_table() {
  constexpr std::nullptr_t free_tile = nullptr, no_chamber = nullptr;
  constexpr Topology sphere = Topology::sphere, disk = Topology::disk;
  static const std::vector<Family> table = {
      {"532", "60", three_vertices, rotations({2, 3, 5}), sphere, doubled_triangle, triangle_of_marks},
      {"432", "24", three_vertices, rotations({2, 3, 4}), sphere, doubled_triangle, triangle_of_marks},
      {"332", "12", three_vertices, rotations({2, 3, 3}), sphere, doubled_triangle, triangle_of_marks},
      {"22N", "2N", three_vertices, rotations({2, 2, N}), sphere, doubled_triangle, triangle_of_marks},
      about_one_axis({"NN", "N", two_vertices, rotations({N, N}), sphere, glued_lune, triangle_at_equator}),
      {"*532", "120", three_boundary_vertices, corners({2, 3, 5}), disk, mirrored_triangle,
       triangle_of_marks},
      {"*432", "48", three_boundary_vertices, corners({2, 3, 4}), disk, mirrored_triangle, triangle_of_marks},
      {"*332", "24", three_boundary_vertices, corners({2, 3, 3}), disk, mirrored_triangle, triangle_of_marks},
      {"*22N", "4N", three_boundary_vertices, corners({2, 2, N}), disk, mirrored_triangle, triangle_of_marks},
      about_one_axis(
          {"*NN", "2N", two_boundary_vertices, corners({N, N}), disk, mirrored_lune, triangle_at_equator}),
      {"3*2", "24", vertex_on_each_side, mixed(3, {2}), disk, mirrored_kite, triangle_at_mirror, true},
      {"2*N", "4N", vertex_on_each_side, mixed(2, {N}), disk, mirrored_kite, triangle_at_mirror, true},
      about_one_axis({"N*", "2N", one_vertex_inside, mixed(N, {}), disk, sector, triangle_at_equator, true}),
      {"Nx", "2N", one_vertex, crossed(N), Topology::projective_plane, crossed_lune, triangle_at_equator,
       false, 1},
      {"1", "1", none_marked, nothing_marked, sphere, whole_sphere, octant},
      {"*", "2", none_marked, mirror_alone, disk, hemisphere, octant, true},
      {"333", infinite, three_vertices, rotations({3, 3, 3}), sphere, doubled_triangle, triangle_of_marks},
      filling(quarter_at_order_4, {"442", infinite, three_vertices, rotations({2, 4, 4}), sphere,
                                   doubled_triangle, triangle_of_marks}),
      {"632", infinite, three_vertices, rotations({2, 3, 6}), sphere, doubled_triangle, triangle_of_marks},
      filling(half_at_order_2,
              {"2222", infinite, four_vertices, rotations({2, 2, 2, 2}), sphere, free_tile, no_chamber}),
      {"*333", infinite, three_boundary_vertices, corners({3, 3, 3}), disk, mirrored_triangle,
       triangle_of_marks},
      {"*442", infinite, three_boundary_vertices, corners({2, 4, 4}), disk, mirrored_triangle,
       triangle_of_marks},
      {"*632", infinite, three_boundary_vertices, corners({2, 3, 6}), disk, mirrored_triangle,
       triangle_of_marks},
      filling(quarter_at_order_2, {"*2222", infinite, four_boundary_vertices, corners({2, 2, 2, 2}), disk,
                                   free_tile, no_chamber}),
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

bool is_of_three_half_turns(const ConwaySymbol& symbol) {
  const std::vector<int> none, three = {2, 2, 2};
  return !symbol.cross && symbol.rotations == (symbol.star ? none : three) &&
         symbol.corners == (symbol.star ? three : none);
}

}  // namespace orbitutte
