// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/free_tile.h"

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <numbers>
#include <utility>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/orbifold/seam_group.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// The rotation about a cone, and where the boundary of the cut mesh meets it first. Partial products in the
// hyperbolic plane may be much larger than the whole, and doubles would lose its digits.
struct MetCone {
  int place = 0;
  Matrix3Of<Precise> rotation;
};

Matrix3Of<Precise> rotation_about(Space space, const Vector3& point, const Mark& mark) {
  const Vector3Of<Precise> centre = precise_retract<Precise>(space, point.cast<Precise>());
  return precise_rotation(space, centre, precise_angle<Precise>(mark));
}

// The cones in the order in which the boundary meets them.
std::vector<MetCone> met_cones(const Target& target, const CutMesh& cut, const Points& positions) {
  std::vector<MetCone> met;
  for (int place = 0; place < static_cast<int>(cut.boundary.size()); ++place) {
    const int v = cut.boundary[place];
    for (int k = 0; k < target.inner_marks; ++k)
      if (cut.marks[k] == v)
        met.push_back({place, rotation_about(target.space, positions.row(v), target.marks[k])});
  }
  return met;
}

// The corners of a disk, or where its boundary begins, in the same order.
std::vector<int> places_of_corners(const Target& target, const CutMesh& cut) {
  std::vector<int> places;
  for (int place = 0; place < static_cast<int>(cut.boundary.size()); ++place)
    if (std::find(cut.marks.begin() + target.inner_marks, cut.marks.end(), cut.boundary[place]) !=
        cut.marks.end())
      places.push_back(place);
  return places;
}

// The product of the rotations about the cones that are met after `after`, up to `last`.
Matrix3Of<Precise> product_of_met(const std::vector<MetCone>& met, int after, int last) {
  Matrix3Of<Precise> product = Matrix3Of<Precise>::Identity();
  for (const MetCone& cone : met)
    if (after < cone.place && cone.place <= last) product = product * cone.rotation;
  return product;
}

// The same in doubles.
Matrix3 product_between(const std::vector<MetCone>& met, int after, int last) {
  return product_of_met(met, after, last).cast<double>();
}

// The mark that an input vertex is; the number of the target's marks if it is none.
int mark_at(const Target& target, const CutMesh& cut, int vertex) {
  int mark = 0;
  while (mark < static_cast<int>(target.marks.size()) && cut.marks[mark] != vertex) ++mark;
  return mark;
}

// The angle of the tile there, over all copies.
double tile_angle_at(const Target& target, int mark) {
  return mark < static_cast<int>(target.marks.size()) ? target.marks[mark].angle : pi;
}

// May positions be chosen there? At marks, and where the boundary of a disk without corners begins.
bool has_chosen_position(const CutMesh& cut, int vertex) {
  return std::find(cut.marks.begin(), cut.marks.end(), vertex) != cut.marks.end();
}

// The line of the mirror along which a walk around the tile goes: a point of it, and its direction.
struct MirrorLine {
  Vector3 point;
  double angle = 0;

  Vector3 direction() const { return {std::cos(angle), std::sin(angle), 0}; }

  // By how much p lies to its left.
  double distance(const Vector3& p) const { return direction().cross(p - point).z(); }

  // The same line seen from behind a cut that ends on it: g takes what is behind to what is before.
  MirrorLine behind(const Isometry& g) const {
    const double turn = std::atan2(g.matrix()(1, 0), g.matrix()(0, 0));
    return {g.inverse() * point, angle - turn};
  }
};

// The sides of the tile, one after the other, from the corners and gluings of those before.
class TileWalk {
 public:
  TileWalk(const Target& target, const CutMesh& cut, const Points& positions)
      : target_(target),
        cut_(cut),
        positions_(positions),
        met_(met_cones(target, cut, positions)),
        corner_places_(places_of_corners(target, cut)) {
    for (int s = 0; s < static_cast<int>(cut.sides.size()); ++s) add_side(s);
    measure_chords();
  }

  Tile tile() && { return std::move(tile_); }

  std::vector<double> closing_defects() const {
    if (target_.topology == Topology::sphere) {
      const Matrix3 product = product_between(met_, -1, static_cast<int>(cut_.boundary.size()));
      return {product(0, 2), product(1, 2)};
    }
    std::vector<double> defects = defects_;
    defects.push_back(
        mirror_.distance(tile_.sides.front().start));  // the last mirror leads to the first mark
    return defects;
  }

 private:
  int copy_at(int s) const { return cut_.boundary[cut_.sides[s].begin]; }

  // Copies are met on the way back along a side, whose corners are images of its partner's.
  Vector3 corner(int s) const {
    if (copy_at(s) < positions_.rows()) return positions_.row(copy_at(s));
    const TileSide& before = tile_.sides[s - 1];
    return before.transform * tile_.sides[before.partner].start;
  }

  void add_side(int s) {
    const int partner = cut_.sides[s].partner, vertex = cut_.source_vertex[copy_at(s)];
    TileSide side;
    side.space = target_.space;
    side.start = corner(s);
    side.mark = mark_at(target_, cut_, vertex);
    side.slides = !has_chosen_position(cut_, vertex);
    side.partner = partner;
    if (partner == s && side.space == Space::plane()) {
      advance_mirror(s);
      side.direction = mirror_.direction();
      side.transform = side.space.reflection(Space::line(mirror_.point, mirror_.point + side.direction));
    } else if (partner == s) {
      side.transform = mirror_through_corners(cut_.sides[s].begin);
    } else {
      side.direction = Vector3::UnitX();
      side.transform = partner > s ? gluing(s, partner) : tile_.sides[partner].transform.inverse();
    }
    tile_.sides.push_back(std::move(side));
  }

  // The product of the rotations in between. It has more digits than doubles, and is rounded once: to correct
  // it in doubles would lose the third power of its entries.
  Isometry gluing(int s, int partner) const {
    return target_.space.isometry(product_between(met_, cut_.sides[s].begin, cut_.sides[partner].begin));
  }

  // The reflection in the mirror at a place of the boundary: in the line from the corner before to the next
  // one, which is seen from there through the cones that are met in between, as the place itself is.
  Isometry mirror_through_corners(int place) const {
    const auto after = std::upper_bound(corner_places_.begin(), corner_places_.end(), place);
    const int from = *std::prev(after);
    const bool is_last = after == corner_places_.end();
    const int to = is_last ? corner_places_.front() : *after;
    const auto seen = [&](int at, int until) -> Vector3Of<Precise> {
      const Vector3 p = positions_.row(cut_.boundary[at]);
      return product_of_met(met_, from, until) * precise_retract<Precise>(target_.space, p.cast<Precise>());
    };
    const Vector3Of<Precise> line =
        seen(from, from).cross(seen(to, is_last ? static_cast<int>(cut_.boundary.size()) : to));
    const Matrix3Of<Precise> behind = product_of_met(met_, from, place);
    const Matrix3Of<Precise> reflection =
        precise_inverse(target_.space, behind) * precise_reflection(target_.space, line) * behind;
    return target_.space.isometry(reflection.cast<double>());
  }

  // In the plane, from the mirror before to that of side s: around the corner between them, and behind the
  // cuts that end there.
  void advance_mirror(int s) {
    const int first = after_mirror_;  // whose corner the boundary has not met before
    const Vector3 p = corner(first);
    if (first == 0) {
      mirror_.point = p;
    } else if (has_chosen_position(cut_, copy_at(first))) {
      defects_.push_back(mirror_.distance(p));
      mirror_ = {p, mirror_.angle + pi - tile_angle_at(target_, mark_at(target_, cut_, copy_at(first)))};
    }
    mirror_ = mirror_.behind(
        target_.space.isometry(product_between(met_, cut_.sides[first].begin, cut_.sides[s].begin)));
    after_mirror_ = s + 1;
  }

  // Lengths of all sides, and their directions: those of their chords. Sides that are glued to others are no
  // geodesics; mirrors are, and a shape in the plane may be turned by half a turn from how the walk has it.
  void measure_chords() {
    for (int s = 0; s < static_cast<int>(tile_.sides.size()); ++s) {
      TileSide& side = tile_.sides[s];
      const Vector3 end = tile_.sides[(s + 1) % tile_.sides.size()].start;
      side.length = side.space.distance(side.start, end);
      if (side.partner == s && side.space == Space::plane()) {
        if (side.space.dot(side.direction, end - side.start) < 0) side.direction = -side.direction;
        continue;
      }
      if (!(side.length > 0)) continue;
      side.direction = side.space.tangent(side.start, end - side.start);
      side.direction /= side.space.norm(side.direction);
    }
  }

  const Target& target_;
  const CutMesh& cut_;
  const Points& positions_;
  std::vector<MetCone> met_;
  std::vector<int> corner_places_;
  Tile tile_;

  // In the plane.
  MirrorLine mirror_;
  int after_mirror_ = 0;  // the side after the last mirror
  std::vector<double> defects_;
};

// An orthonormal basis of the vectors that a matrix takes to zero, one a column.
template <typename Matrix>
Matrix null_space_of(const Matrix& matrix) {
  const Eigen::ColPivHouseholderQR<Matrix> factors(matrix.adjoint());
  const Matrix Q = factors.householderQ();
  return Q.rightCols(matrix.cols() - factors.rank());
}

// Positions of all input vertices.
Points all_at_origin(const CutMesh& cut) {
  const int vertices = 1 + *std::max_element(cut.source_vertex.begin(), cut.source_vertex.end());
  return Space::origin().transpose().replicate(vertices, 1);
}

// The defects as a matrix on the coordinates x, y, x, y ... of the marks, and below it the sums of x and of
// y.
Eigen::MatrixXd closing_conditions(const Target& target, const CutMesh& cut) {
  const auto marks = static_cast<Eigen::Index>(cut.marks.size());
  Points positions = all_at_origin(cut);
  std::vector<std::vector<double>> columns;
  for (const int vertex : cut.marks) {
    for (const Vector3& unit : {Vector3(1, 0, 0), Vector3(0, 1, 0)}) {
      positions.row(vertex) = Space::origin() + unit;
      columns.push_back(closing_defects(target, cut, positions));
    }
    positions.row(vertex) = Space::origin();
  }
  const auto defects = static_cast<Eigen::Index>(columns.front().size());
  Eigen::MatrixXd matrix(defects + 2, 2 * marks);
  for (Eigen::Index k = 0; k < 2 * marks; ++k) {
    matrix.col(k).head(defects) = Eigen::Map<const Eigen::VectorXd>(columns[k].data(), defects);
    matrix.col(k).tail(2) = k % 2 == 0 ? Eigen::Vector2d(1, 0) : Eigen::Vector2d(0, 1);
  }
  return matrix;
}

// The shortest of all p + m u + n v with whole m and n. u and v are reduced first (Lagrange and Gauss).
Vector3 nearest_modulo(const Vector3& p, Vector3 u, Vector3 v) {
  for (;;) {
    if (u.squaredNorm() > v.squaredNorm()) std::swap(u, v);
    const double times = std::round(u.dot(v) / u.squaredNorm());
    if (!(std::abs(times) >= 1)) break;
    v -= times * u;
  }
  Eigen::Matrix<double, 3, 2> lattice;
  lattice << u, v;
  const Eigen::Vector2d nearest = lattice.colPivHouseholderQr().solve(p).array().round();
  const Vector3 start = p - lattice * nearest;
  Vector3 best = start;
  for (int m = -1; m <= 1; ++m)
    for (int n = -1; n <= 1; ++n)
      if (const Vector3 other = start + m * u + n * v; other.squaredNorm() < best.squaredNorm() * (1 - 1e-9))
        best = other;
  return best;
}

}  // namespace

Tile tile_through(const Target& target, const CutMesh& cut, const Points& positions) {
  return TileWalk(target, cut, positions).tile();
}

Points spread_on_free_tile(const Target& target, const CutMesh& cut, const Points& positions) {
  const std::vector<MetCone> met = met_cones(target, cut, positions);
  const auto count_met = [&](int place) {
    return std::count_if(met.begin(), met.end(), [&](const MetCone& cone) { return cone.place <= place; });
  };
  std::map<std::pair<std::ptrdiff_t, std::ptrdiff_t>, Matrix3Of<Precise>> elements;  // by how many were met
  std::vector<int> place(cut.source_vertex.size(), 0);
  Points result(cut.vertex_count(), 3);
  result.topRows(positions.rows()) = positions;
  for (int b = 0; b < static_cast<int>(cut.boundary.size()); ++b) {
    const int v = cut.boundary[b], source = cut.source_vertex[v];
    place[v] = b;
    if (v == source) continue;
    const auto [at, is_new] = elements.try_emplace({count_met(place[source]), count_met(b)});
    if (is_new) at->second = precise_inverse(target.space, product_of_met(met, place[source], b));
    const Vector3Of<Precise> there = positions.row(source).transpose().cast<Precise>();
    result.row(v) = Vector3Of<Precise>(at->second * there).cast<double>();
  }
  return result;
}

std::vector<double> closing_defects(const Target& target, const CutMesh& cut, const Points& positions) {
  return TileWalk(target, cut, positions).closing_defects();
}

Vector3 closing_position(const Target& target, const CutMesh& cut, const Points& positions) {
  if (target.topology != Topology::sphere) return positions.row(cut.marks.front());
  const std::vector<MetCone> met = met_cones(target, cut, positions);
  const Matrix3Of<Precise> others =
      product_of_met(met, met.front().place, static_cast<int>(cut.boundary.size()));
  return precise_fixed_point(target.space, others, positions.row(cut.marks.front())).cast<double>();
}

TileShapes tile_shapes(const Target& target, const CutMesh& cut) {
  const Eigen::MatrixXd matrix = closing_conditions(target, cut);
  const auto marks = static_cast<Eigen::Index>(cut.marks.size());
  if (target.topology == Topology::sphere) {  // then the defects are linear over the complex numbers
    Eigen::MatrixXcd complex = Eigen::MatrixXcd::Ones(2, marks);
    for (Eigen::Index k = 0; k < marks; ++k) complex(0, k) = {matrix(0, 2 * k), matrix(1, 2 * k)};
    return {null_space_of(complex), true};
  }
  const Eigen::MatrixXd coordinates = null_space_of(matrix);
  TileShapes shapes = {Eigen::MatrixXcd(marks, coordinates.cols()), false};
  for (Eigen::Index k = 0; k < marks; ++k)
    for (Eigen::Index j = 0; j < coordinates.cols(); ++j)
      shapes.basis(k, j) = {coordinates(2 * k, j), coordinates(2 * k + 1, j)};
  return shapes;
}

Points positions_of_marks(const CutMesh& cut, const Eigen::VectorXcd& shape) {
  Points positions = all_at_origin(cut);
  for (std::size_t k = 0; k < cut.marks.size(); ++k) {
    const std::complex<double> z = shape[static_cast<Eigen::Index>(k)];
    positions.row(cut.marks[k]) << z.real(), z.imag(), 1;
  }
  return positions;
}

std::vector<int> cones_as_met(const CutMesh& cut) {
  std::vector<int> cones;
  for (const int mark : cut.arrangement) cones.push_back(cut.marks[mark]);
  return cones;
}

Moduli moduli_of(const Target& target, const CutMesh& cut) {
  std::vector<Mark> marks;
  for (const int mark : cut.arrangement)
    marks.push_back(mark < static_cast<int>(target.marks.size()) ? target.marks[mark]
                                                                 : Mark{pi, ConeKind::corner});
  return {target.space, std::move(marks)};
}

void require_shapes(const Target& target) {
  if (!target.has_curved_free_tile()) return;
  std::vector<Mark> marks(target.marks.begin() + target.inner_marks, target.marks.end());
  if (marks.empty() && target.topology == Topology::disk) marks.push_back({pi, ConeKind::corner});
  marks.insert(marks.end(), target.marks.begin(), target.marks.begin() + target.inner_marks);
  Moduli(target.space, std::move(marks));
}

Vector3 point_towards_x(const Target& target, const CutMesh& cut, const Points& positions) {
  const auto from_first = [&](int k) -> Vector3 {
    return positions.row(cut.marks[k]) - positions.row(cut.marks[0]);
  };
  const bool is_pillow = target.symbol.rotations.size() == 4 && target.space == Space::plane();
  if (!is_pillow) return positions.row(cut.marks[1]);
  return nearest_modulo(from_first(1), 2 * from_first(1), 2 * from_first(2));
}

Tile any_tile(const Target& target, const CutMesh& cut) {
  if (target.space == Space::plane())
    return tile_through(target, cut, positions_of_marks(cut, tile_shapes(target, cut).basis.col(0)));
  Points positions = all_at_origin(cut);
  const Points polygon = moduli_of(target, cut).inscribed_polygon();
  const std::vector<int> cones = cones_as_met(cut);
  for (std::size_t k = 0; k < cones.size(); ++k)
    positions.row(cones[k]) = polygon.row(static_cast<Eigen::Index>(k));
  return tile_through(target, cut, positions);
}

}  // namespace orbitutte
