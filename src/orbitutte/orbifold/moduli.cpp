// SPDX-License-Identifier: MIT
#include "orbitutte/orbifold/moduli.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "orbitutte/orbifold/cone_target.h"
#include "orbitutte/orbifold/inscribed_polygon.h"
#include "orbitutte/orbifold/precise_generators.h"

namespace orbitutte {
namespace {

using std::numbers::pi;

// Curved surfaces of less area are flat up to rounding.
constexpr double least_area = 1e-9;

// What the product of all rotations, which is near the identity, exceeds it by.
Matrix3 excess_of_product(Space space, const MarkOrder& order, const Points& positions) {
  const Matrix3Of<Precise> excess =
      precise_product(precise_rotations(space, order, positions)) - Matrix3Of<Precise>::Identity();
  return excess.cast<double>();
}

double largest_partial_product(const std::vector<Isometry>& rotations) {
  Isometry partial;
  double largest = 1;
  for (const Isometry& rotation : rotations) {
    partial = partial * rotation;
    largest = std::max(largest, partial.matrix().cwiseAbs().maxCoeff());
  }
  return largest;
}

// The angles of the sphere that the surface, or two copies of it, glued along their boundaries, make. A
// corner of pi is no mark there.
std::vector<double> angles_on_sphere(const MarkOrder& order) {
  std::vector<double> angles;
  for (const Mark& mark : order.marks()) {
    if (mark.kind != ConeKind::corner) {
      angles.push_back(mark.angle);
      if (order.is_disk()) angles.push_back(mark.angle);
    } else if (mark.angle != pi) {
      angles.push_back(2 * mark.angle);
    }
  }
  return angles;
}

void require_angles(Space space, const std::vector<Mark>& marks) {
  for (const Mark& mark : marks) {
    const bool is_corner = mark.kind == ConeKind::corner;
    const double largest = (is_corner ? 1 : 2) * (space.is_closed() ? 1 : 2) * pi;
    if (!(mark.angle > 0) || !(mark.angle < largest || (is_corner && mark.angle == pi)))
      throw ArgumentError(
          fmt::format("the angle {:.6g} pi of a {} is not supported in the {} space; it must "
                      "lie between 0 and {:.6g} pi",
                      mark.angle / pi, is_corner ? "corner" : "cone", space.name(), largest / pi));
  }
}

void require_surfaces(Space space, const MarkOrder& order, double area) {
  const bool is_disk = order.is_disk();
  const std::vector<double> angles = angles_on_sphere(order);
  if (angles.size() < 3)
    throw ArgumentError(
        is_disk
            ? fmt::format("a curved disk needs three corners or more, a cone counting as two of them, not {}",
                          angles.size())
            : fmt::format("a cone surface needs three cones or more, not {}", angles.size()));
  require_angles(space, order.marks());
  if (space.curvature() == 0) return;
  if (!(area >= least_area))
    throw ArgumentError(
        fmt::format("no {} surface has these angles: its area would be {:.6g}", space.name(), area));
  const int sheets = is_disk ? 2 : 1;
  const double least = *std::min_element(angles.begin(), angles.end()) / sheets;
  if (space.curvature() > 0 && !(area < 2 * least))
    throw ArgumentError(fmt::format(
        "no spherical surface has these angles: its area would be {:.6g} pi, and has to be less than {:.6g} "
        "pi, twice the least angle{} (Troyanov's bound); make the least angle larger or others smaller",
        area / pi, 2 * least / pi, is_disk ? ", cones counting by half" : ""));
}

// The marks of a sphere with these angles.
std::vector<Mark> cones_of_angles(const std::vector<double>& angles) {
  std::vector<Mark> marks;
  marks.reserve(angles.size());
  for (const double angle : angles) marks.push_back({angle, ConeKind::rotation});
  return marks;
}

}  // namespace

Moduli::Moduli(Space space, const std::vector<double>& angles) : Moduli(space, cones_of_angles(angles)) {}

Moduli::Moduli(Space space, std::vector<Mark> marks) : space_(space), order_(std::move(marks)) {
  if (mark_count() == 0) throw ArgumentError("a cone surface needs three cones or more, not 0");
  require_surfaces(space_, order_, area());
}

int Moduli::dimension() const {
  const int conditions = order_.is_disk() ? static_cast<int>(order_.corners().size()) : 3;
  return 2 * mark_count() - 3 - conditions;
}

double Moduli::area() const {
  const Topology topology = order_.is_disk() ? Topology::disk : Topology::sphere;
  return space_.curvature() * total_curvature(topology, marks());
}

std::vector<Isometry> Moduli::rotations(const Points& at) const {
  std::vector<Isometry> result(mark_count());
  for (int i = 0; i < mark_count(); ++i)
    if (!order_.is_corner(i)) result[i] = space_.rotation(at.row(i), marks()[i].angle);
  return result;
}

std::pair<Vector3, Vector3> Moduli::corners_beside(int corner, const std::vector<Isometry>& rotations,
                                                   const Points& marks) const {
  const int next = order_.corner_after(corner), last = order_.corner_before(corner);
  return {order_.product_up_to_corner(corner, rotations, Isometry()) * Vector3(marks.row(next)),
          order_.product_up_to_corner(last, rotations, Isometry()).inverse() * Vector3(marks.row(last))};
}

std::vector<Isometry> Moduli::generators(const Points& marks) const {
  const std::vector<Isometry> about = rotations(marks);
  std::vector<Isometry> result = about;
  for (const int corner : order_.corners())
    result[corner] =
        space_.reflection(Space::line(marks.row(corner), corners_beside(corner, about, marks).first));
  return result;
}

VaryingMarks Moduli::varying(const Points& marks) const {
  return varying(marks, Eigen::MatrixXd::Identity(2 * mark_count(), 2 * mark_count()), Order::first);
}

Eigen::VectorXd Moduli::closing(const Points& at) const {
  if (!order_.is_disk())
    return infinitesimal_part(space_, excess_of_product(space_, order_, at)).head(closing_rows(space_));
  const std::vector<Isometry> about = rotations(at);
  std::vector<double> off;
  for (const int corner : order_.corners()) {
    const auto [next, last] = corners_beside(corner, about, at);
    off.push_back(std::remainder(space_.angle(at.row(corner), next, last) - marks()[corner].angle, pi));
  }
  return Eigen::Map<const Eigen::VectorXd>(off.data(), static_cast<Eigen::Index>(off.size()));
}

Eigen::MatrixXd Moduli::closing_jacobian(const Points& marks) const { return varying(marks).closing_rates(); }

Points Moduli::tangents(const Points& marks, const Eigen::VectorXd& step) const {
  Points result(mark_count(), 3);
  for (int i = 0; i < mark_count(); ++i)
    result.row(i) = (tangent_frame(space_, marks.row(i)) * step.segment<2>(2 * i)).transpose();
  return result;
}

Eigen::VectorXd Moduli::coordinates(const Points& marks, const Points& tangents) const {
  Eigen::VectorXd result(2 * mark_count());
  for (int i = 0; i < mark_count(); ++i) {
    const Eigen::Matrix<double, 3, 2> directions = tangent_frame(space_, marks.row(i));
    for (int a = 0; a < 2; ++a)
      result[2 * i + a] = space_.dot(directions.col(a), tangents.row(i).transpose());
  }
  return result;
}

// The last right singular vectors of [closing_jacobian; isometries; scaling], whose rank is what 2k exceeds
// the dimension by.
Eigen::MatrixXd Moduli::basis(const Points& marks) const {
  const Eigen::MatrixXd closing = closing_jacobian(marks);
  const bool has_similarities = space_.curvature() == 0;
  Eigen::MatrixXd held(closing.rows() + 3 + (has_similarities ? 1 : 0), 2 * mark_count());
  held.topRows(closing.rows()) = closing;
  for (int a = 0; a < 3; ++a) {
    const Matrix3 motion = infinitesimal_isometry(space_, Vector3::Unit(a));
    held.row(closing.rows() + a) = coordinates(marks, marks * motion.transpose()).transpose();
  }
  if (has_similarities) {
    const Points from_middle = marks.rowwise() - marks.colwise().mean();
    held.row(held.rows() - 1) = coordinates(marks, from_middle).transpose();
  }
  held.rowwise().normalize();
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(held, Eigen::ComputeFullV);
  return svd.matrixV().rightCols(dimension());
}

std::optional<Points> Moduli::closed(const Points& marks) const {
  constexpr int most_steps = 50;
  constexpr double longest_step = 0.5;
  Points best = marks, current = marks;
  double least = std::numeric_limits<double>::infinity();
  for (int step = 0, without_gain = 0; step < most_steps && without_gain < 3; ++step) {
    const Eigen::VectorXd residual = closing(current);
    const double size = residual.cwiseAbs().maxCoeff();
    if (!std::isfinite(size)) return std::nullopt;
    without_gain = size < 0.5 * least ? 0 : without_gain + 1;
    if (size < least) least = size, best = current;
    if (size == 0) break;
    Eigen::VectorXd move = -closing_jacobian(current).completeOrthogonalDecomposition().solve(residual);
    const double longest = move.cwiseAbs().maxCoeff();
    if (space_.curvature() != 0 && longest > longest_step) move *= longest_step / longest;
    const Points direction = tangents(current, move);
    move_points(space_, Points(current), direction, 1, current);
  }
  if (!closes(best) || !encloses_area(best)) return std::nullopt;
  return best;
}

// Up to rounding, which grows with the coordinates.
bool Moduli::closes(const Points& marks) const {
  const std::vector<Isometry> about = rotations(marks);
  const double scale = std::pow(std::max(largest_partial_product(about), marks.cwiseAbs().maxCoeff()), 2);
  const double off = order_.is_disk() ? closing(marks).cwiseAbs().maxCoeff()
                                      : excess_of_product(space_, order_, marks).cwiseAbs().maxCoeff();
  return off < 1e-12 * scale;
}

std::optional<Points> Moduli::retract(const Points& marks, const Eigen::VectorXd& step) const {
  Points moved(mark_count(), 3);
  const Points direction = tangents(marks, step);
  for (int i = 0; i < mark_count(); ++i) {
    const Vector3 u = direction.row(i);
    const double length = space_.norm(u);
    moved.row(i) =
        length > 0 ? space_.retract(space_.at(marks.row(i), u / length, length)) : Vector3(marks.row(i));
  }
  return closed(moved);
}

namespace {

// The point from which the others are seen best: the farthest from being opposite to any of them on the
// sphere, where the directions to the opposite point are lost.
Vector3 best_seen_from(Space space, const std::vector<Vector3>& points) {
  if (!space.is_closed()) return points.front();
  const auto from_opposite = [&](const Vector3& at) {
    double least = std::numeric_limits<double>::infinity();
    for (const Vector3& point : points) least = std::min(least, (at + point).squaredNorm());
    return least;
  };
  return *std::max_element(points.begin(), points.end(), [&](const Vector3& p, const Vector3& q) {
    return from_opposite(p) < from_opposite(q);
  });
}

}  // namespace

// Of the polygon that the surface becomes if every cone is joined by a cut of its own to the first mark, or
// to the corner before it: at the cone its boundary turns back to what the cone's rotation makes of that.
bool Moduli::encloses_area(const Points& marks) const {
  if (space_.curvature() == 0) return true;
  const std::vector<Isometry> about = rotations(marks);
  std::vector<Vector3> corners = {marks.row(0)};
  Vector3 root = corners.front();
  for (int i = 1; i < mark_count(); ++i) {
    corners.emplace_back(marks.row(i));
    root = order_.is_corner(i) ? corners.back() : Vector3(about[i].inverse() * root);
    if (!order_.is_corner(i)) corners.push_back(root);
  }
  const Vector3 from = best_seen_from(space_, corners);
  double off = -area();
  for (std::size_t c = 0; c < corners.size(); ++c)
    off += space_.area(from, corners[c], corners[(c + 1) % corners.size()]);
  // A mirror may be longer than the chord, which runs the other way around.
  if (space_.is_closed()) off = std::remainder(off, order_.is_disk() ? 2 * pi : 4 * pi);
  return std::abs(off) < 1e-3;
}

Points Moduli::inscribed_polygon() const {
  std::vector<double> angles;
  std::vector<Eigen::Index> places;
  for (const auto& [angle, kind] : marks()) {
    const bool is_slit = order_.is_disk() && kind != ConeKind::corner;
    if (is_slit) angles.push_back(pi / 2);
    places.push_back(static_cast<Eigen::Index>(angles.size()));
    angles.push_back(order_.is_disk() ? angle : angle / 2);
    if (is_slit) angles.push_back(pi / 2);
  }
  return orbitutte::inscribed_polygon(space_, angles)(places, Eigen::all);
}

}  // namespace orbitutte
