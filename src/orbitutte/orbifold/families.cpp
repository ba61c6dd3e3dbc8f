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

// The triangle with angles pi/n1, pi/n2, pi/n3 and what builds tiles of it, on the sphere and in the plane.
struct Sphere {
  // The side opposite to the angle a of a spherical triangle with angles a, b, c: the law of cosines for
  // angles.
  static double opposite_side(double a, double b, double c) {
    return std::acos((std::cos(a) + std::cos(b) * std::cos(c)) / (std::sin(b) * std::sin(c)));
  }

  // The point at a distance and direction from the corner p1, the north pole.
  static Vector3 at(double colatitude, double longitude) {
    return {std::sin(colatitude) * std::cos(longitude), std::sin(colatitude) * std::sin(longitude),
            std::cos(colatitude)};
  }

  static TileSide segment(const Vector3& from, const Vector3& to, int mark) {
    return great_arc(from, to, mark);
  }

  static Matrix3 rotation_about(const Vector3& point, double angle) { return rotation(point, angle); }
  static Matrix3 reflection_in(const TileSide& side) { return reflection(side.pole().normalized()); }
};

struct Plane {
  // The law of sines, for a triangle whose circumscribed circle has diameter one.
  static double opposite_side(double a, double, double) { return std::sin(a); }

  static Vector3 at(double distance, double angle) {
    return {distance * std::cos(angle), distance * std::sin(angle), 1};
  }

  static TileSide segment(const Vector3& from, const Vector3& to, int mark) {
    TileSide side;
    side.start = from;
    side.direction = (to - from).normalized();
    side.length = (to - from).norm();
    side.mark = mark;
    side.geometry = Geometry::euclidean;
    return side;
  }

  static Matrix3 translation(const Vector3& shift) {
    Matrix3 result = Matrix3::Identity();
    result.col(2) += shift;
    return result;
  }

  static Matrix3 rotation_about(const Vector3& point, double angle) {
    Matrix3 result = rotation(Vector3::UnitZ(), angle);
    result.col(2) = point - result.leftCols<2>() * point.head<2>();
    return result;
  }

  static Matrix3 reflection_in(const TileSide& side) {
    const Vector3 normal(-side.direction.y(), side.direction.x(), 0);
    Matrix3 result = reflection(normal);
    result.col(2) += 2 * normal.dot(side.start) * normal;
    return result;
  }
};

// The corners p1, p2, p3, counterclockwise from outside.
template <typename Space>
std::vector<Vector3> triangle_corners(const std::vector<int>& n) {
  const double a1 = pi / n[0], a2 = pi / n[1], a3 = pi / n[2];
  const double p1p2 = Space::opposite_side(a3, a1, a2), p1p3 = Space::opposite_side(a2, a3, a1);
  return {Space::at(0, 0), Space::at(p1p2, 0), Space::at(p1p3, a1)};
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

template <typename Space>
void make_mirror(Tile& tile, int side) {
  tile.sides[side].partner = side;
  tile.sides[side].transform = Space::reflection_in(tile.sides[side]);
}

template <typename Space>
void make_mirrors(Tile& tile) {
  for (int k = 0; k < static_cast<int>(tile.sides.size()); ++k) make_mirror<Space>(tile, k);
}

void glue_sides(Tile& tile, int left, int right, const Matrix3& transform) {
  tile.sides[left].partner = right;
  tile.sides[left].transform = transform;
  tile.sides[right].partner = left;
  tile.sides[right].transform = inverse_isometry(transform);
}

// The polygon with these corners, no side glued yet.
template <typename Space>
Tile polygon(const std::vector<Vector3>& corners, const std::vector<int>& marks) {
  Tile tile;
  for (std::size_t k = 0; k < corners.size(); ++k)
    tile.sides.push_back(Space::segment(corners[k], corners[(k + 1) % corners.size()], marks[k]));
  return tile;
}

// *n1 n2 n3: the triangle with three mirrors.
template <typename Space>
Tile mirrored_triangle(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = polygon<Space>(triangle_corners<Space>(n), marks);
  make_mirrors<Space>(tile);
  return tile;
}

// The triangle and its mirror image across the side p1 p3: p1, p2, p3 and the image of p2, no side glued yet.
template <typename Space>
Tile kite(const std::vector<int>& n, const std::vector<int>& marks) {
  const std::vector<Vector3> p = triangle_corners<Space>({n[0], n[2], n[1]});  // p1, p3, p2'
  const Vector3 p2 = Space::reflection_in(Space::segment(p[0], p[1], -1)) * p[2];
  return polygon<Space>({p[0], p2, p[1], p[2]}, {marks[0], marks[1], marks[2], marks[1]});
}

// n1 n2 n3: the kite, glued by rotations about p1 and p3.
template <typename Space>
Tile doubled_triangle(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = kite<Space>(n, marks);
  const Vector3 p1 = tile.sides[0].start, p3 = tile.sides[2].start;
  glue_sides(tile, 0, 3, Space::rotation_about(p1, -2 * pi / n[0]));
  glue_sides(tile, 2, 1, Space::rotation_about(p3, -2 * pi / n[2]));
  return tile;
}

// *2222: the unit square with four mirrors. Its sides' ratio is a choice: harmonic maps onto it are not
// conformal.
Tile mirrored_square(const std::vector<int>&, const std::vector<int>& marks) {
  Tile tile = polygon<Plane>({{0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}}, marks);
  make_mirrors<Plane>(tile);
  return tile;
}

// 2222: two unit squares side by side, folded to a pillow by half turns about p1 and p4, the middles of the
// outer sides, and a translation.
Tile pillow(const std::vector<int>&, const std::vector<int>& marks) {
  Tile tile = polygon<Plane>({{0, 0, 1}, {0, -1, 1}, {1, -1, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
                             {marks[0], marks[1], marks[2], marks[3], marks[2], marks[1]});
  glue_sides(tile, 0, 5, Plane::rotation_about(tile.sides[0].start, pi));
  glue_sides(tile, 1, 4, Plane::translation({0, -2, 0}));
  glue_sides(tile, 2, 3, Plane::rotation_about(tile.sides[3].start, pi));
  return tile;
}

// n*m: the kite, cut open from the cone p1 to any point p2 of the mirror, where its angles are right; from
// there one mirror leads to the corner p3, and one from the corner to the image of p2.
Tile mirrored_kite(const std::vector<int>& n, const std::vector<int>& marks) {
  Tile tile = kite<Sphere>({n[0], 2, 2 * n[2]}, marks);
  glue_sides(tile, 0, 3, rotation(tile.sides[0].start, -2 * pi / n[0]));
  for (const int k : {1, 2}) make_mirror<Sphere>(tile, k);
  tile.sides[1].slides = tile.sides[3].slides = true;
  return tile;
}

// N*: a sector of the hemisphere, cut open from the pole to any point of the equator, the mirror. To hold
// that point only chooses one of all rotations about the axis, which change nothing.
Tile sector(const std::vector<int>& n, const std::vector<int>& marks) {
  const double angle = 2 * pi / n[0];
  const Vector3 pole = Vector3::UnitZ(), start = Vector3::UnitX(), end = rotation(pole, angle) * start;
  TileSide equator = Sphere::segment(start, Vector3::UnitY(), marks[1]);
  equator.length = angle;
  Tile tile;
  tile.sides = {Sphere::segment(pole, start, marks[0]), equator, Sphere::segment(end, pole, marks[1])};
  glue_sides(tile, 0, 2, rotation(pole, -angle));
  make_mirror<Sphere>(tile, 1);
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
  make_mirrors<Sphere>(tile);
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

Family euclidean(const std::string& name, const ConwaySymbol& pattern,
                 Tile (*tile)(const std::vector<int>&, const std::vector<int>&)) {
  Family family = {name,
                   "infinite",
                   "as many as orders, in their order",
                   pattern,
                   pattern.star ? Topology::disk : Topology::sphere,
                   tile};
  family.geometry = Geometry::euclidean;
  return family;
}

const std::string three_vertices = "three vertices, in the order of the digits";
const std::string two_vertices = "two vertices";
const std::string three_boundary_vertices = "three boundary vertices, in the order of the digits";
const std::string two_boundary_vertices = "two boundary vertices";
const std::string vertex_on_each_side =
    "one vertex inside (first order), then one on the boundary (second order)";
const std::string one_vertex_inside = "one vertex inside";
const std::string one_vertex = "one vertex";

}  // namespace

const std::vector<Family>& family_table() {
  static const std::vector<Family> table = {
      {"532", "60", three_vertices, rotations({2, 3, 5}), Topology::sphere, doubled_triangle<Sphere>},
      {"432", "24", three_vertices, rotations({2, 3, 4}), Topology::sphere, doubled_triangle<Sphere>},
      {"332", "12", three_vertices, rotations({2, 3, 3}), Topology::sphere, doubled_triangle<Sphere>},
      {"22N", "2N", three_vertices, rotations({2, 2, N}), Topology::sphere, doubled_triangle<Sphere>},
      {"NN", "N", two_vertices, rotations({N, N}), Topology::sphere, glued_lune},
      {"*532", "120", three_boundary_vertices, corners({2, 3, 5}), Topology::disk, mirrored_triangle<Sphere>},
      {"*432", "48", three_boundary_vertices, corners({2, 3, 4}), Topology::disk, mirrored_triangle<Sphere>},
      {"*332", "24", three_boundary_vertices, corners({2, 3, 3}), Topology::disk, mirrored_triangle<Sphere>},
      {"*22N", "4N", three_boundary_vertices, corners({2, 2, N}), Topology::disk, mirrored_triangle<Sphere>},
      {"*NN", "2N", two_boundary_vertices, corners({N, N}), Topology::disk, mirrored_lune},
      {"3*2", "24", vertex_on_each_side, mixed(3, {2}), Topology::disk, mirrored_kite, true},
      {"2*N", "4N", vertex_on_each_side, mixed(2, {N}), Topology::disk, mirrored_kite, true},
      {"N*", "2N", one_vertex_inside, mixed(N, {}), Topology::disk, sector, true},
      {"Nx", "2N", one_vertex, crossed(N), Topology::projective_plane, crossed_lune, false, 1},
      euclidean("333", rotations({3, 3, 3}), doubled_triangle<Plane>),
      euclidean("442", rotations({2, 4, 4}), doubled_triangle<Plane>),
      euclidean("632", rotations({2, 3, 6}), doubled_triangle<Plane>),
      euclidean("2222", rotations({2, 2, 2, 2}), pillow),
      euclidean("*333", corners({3, 3, 3}), mirrored_triangle<Plane>),
      euclidean("*442", corners({2, 4, 4}), mirrored_triangle<Plane>),
      euclidean("*632", corners({2, 3, 6}), mirrored_triangle<Plane>),
      euclidean("*2222", corners({2, 2, 2, 2}), mirrored_square),
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

const Family* find_family(const ConwaySymbol& symbol, Geometry geometry) {
  for (const Family& family : family_table()) {
    if (family.geometry == geometry && symbol.star == family.pattern.star &&
        symbol.cross == family.pattern.cross &&
        fits(symbol.rotations, family.pattern.rotations, family.smallest_order) &&
        fits(symbol.corners, family.pattern.corners, family.smallest_order))
      return &family;
  }
  return nullptr;
}

}  // namespace orbitutte
