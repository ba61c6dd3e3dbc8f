// SPDX-License-Identifier: MIT
// W. M. Goldman, "The symplectic nature of fundamental groups of surfaces", Advances in Mathematics 54
// (1984): how products of isometries change with their factors.
#include "orbitutte/orbifold/moduli.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace orbitutte {
namespace {

using std::numbers::pi;

// Curved surfaces of less area are flat up to rounding.
constexpr double least_area = 1e-9;

// The inverse of infinitesimal_isometry, of the part of a matrix that is one: w.
Vector3 infinitesimal_part(Space space, const Matrix3& M) {
  const int k = space.curvature();
  const double halves = 1 + k * k;  // entries that show x and y: two if the space is curved
  return {(k * M(2, 1) - M(1, 2)) / halves, (M(0, 2) - k * M(2, 0)) / halves, (M(1, 0) - M(0, 1)) / 2};
}

// The infinitesimal isometry that moves p by the tangent vector v and does not turn about p: n x J v, with n
// = (k x, k y, z) and J = diag(1, 1, k).
Vector3 moving(Space space, const Vector3& p, const Vector3& v) {
  const int k = space.curvature();
  const Vector3 n(k * p.x(), k * p.y(), p.z()), raised(v.x(), v.y(), k * v.z());
  return n.cross(raised);
}

// The first entries of an infinitesimal isometry, which say all of it: in the plane it is a translation.
int closing_rows(Space space) { return space.curvature() == 0 ? 2 : 3; }

Isometry product_of(const std::vector<Isometry>& rotations) {
  Isometry result;
  for (const Isometry& rotation : rotations) result = result * rotation;
  return result;
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

void require_surfaces(Space space, const std::vector<double>& angles) {
  if (angles.size() < 3)
    throw ArgumentError(fmt::format("a cone surface needs three cones or more, not {}", angles.size()));
  for (const double angle : angles)
    if (!(angle > 0) || !(angle < 2 * pi))
      throw ArgumentError(fmt::format(
          "the cone angle {:.6g} pi is not supported; it must lie between 0 and 2 pi", angle / pi));
  if (space.curvature() == 0) return;
  const double area = cone_area(space, angles);
  if (!(area >= least_area))
    throw ArgumentError(
        fmt::format("no {} surface has these cone angles: its area would be {:.6g}", space.name(), area));
  const double least = *std::min_element(angles.begin(), angles.end());
  if (space.curvature() > 0 && !(area < 2 * least))
    throw ArgumentError(fmt::format(
        "no spherical surface has these cone angles: its area would be {:.6g} pi, and has to be less than "
        "{:.6g} pi, twice the least angle (Troyanov's bound); make the least angle larger or others smaller",
        area / pi, 2 * least / pi));
}

// The polygon with an inscribed circle of radius r. From its centre, the angle between corner i and where the
// circle touches a side there is phi_i, with sin phi_i = cos beta_i/cs(r) and beta_i a quarter of the mark's
// angle; the sum of all phi_i is pi. All follow from phi of the least mark, which alone may be obtuse:
// sin phi_i = sin phi cos beta_i/cos beta. `excess` is phi + beta - pi/2: positive on the sphere, negative in
// the hyperbolic plane.
class InscribedPolygon {
 public:
  InscribedPolygon(Space space, const std::vector<double>& angles) : space_(space) {
    for (const double angle : angles) beta_.push_back(angle / 4);
    least_ = static_cast<int>(std::min_element(beta_.begin(), beta_.end()) - beta_.begin());
    find_excess();
  }

  // Counterclockwise.
  Points corners() const {
    const std::vector<double> phi = central_angles(excess_);
    Points result(static_cast<Eigen::Index>(beta_.size()), 3);
    double direction = 0;
    for (std::size_t i = 0; i < beta_.size(); ++i) {
      if (i > 0) direction += phi[i - 1] + phi[i];
      // sn(D) = sn(r)/sin(beta), cs(D) = cot(phi) cot(beta)
      const double sn = inscribed_sn() / std::sin(beta_[i]), cs = 1 / (std::tan(phi[i]) * std::tan(beta_[i]));
      const Vector3 corner(sn * std::cos(direction), sn * std::sin(direction), cs);
      result.row(static_cast<Eigen::Index>(i)) =
          space_.curvature() < 0 ? space_.lift(corner.x(), corner.y()) : space_.retract(corner);
    }
    return result;
  }

 private:
  double least_phi(double excess) const { return pi / 2 - beta_[least_] + excess; }

  std::vector<double> central_angles(double excess) const {
    const double scale = std::sin(least_phi(excess)) / std::cos(beta_[least_]);
    std::vector<double> phi;
    for (const double beta : beta_) phi.push_back(std::asin(std::min(scale * std::cos(beta), 1.0)));
    phi[least_] = least_phi(excess);
    return phi;
  }

  // At the excess 0 the angles add up to pi less k area/4. At the other end they fall to 0 in the hyperbolic
  // plane; on the sphere they exceed pi within Troyanov's bound.
  void find_excess() {
    const int k = space_.curvature();
    if (k == 0) return;
    double low = k > 0 ? 0 : beta_[least_] - pi / 2, high = k > 0 ? 2 * beta_[least_] : 0;
    for (double middle = (low + high) / 2; low < middle && middle < high; middle = (low + high) / 2) {
      double sum = 0;
      for (const double phi : central_angles(middle)) sum += phi;
      (sum < pi ? low : high) = middle;
    }
    excess_ = high;
  }

  // sn(r)^2 = k (1 - cs(r)^2) = k sin(excess) cos(phi - beta)/sin(phi)^2; in the plane the size is free.
  double inscribed_sn() const {
    if (space_.curvature() == 0) return 1;
    const double phi = least_phi(excess_);
    return std::sqrt(std::max(space_.curvature() * std::sin(excess_) * std::cos(phi - beta_[least_]), 0.0)) /
           std::sin(phi);
  }

  Space space_;
  std::vector<double> beta_;
  int least_ = 0;
  double excess_ = 0;
};

}  // namespace

Matrix3 infinitesimal_isometry(Space space, const Vector3& w) {
  const int k = space.curvature();
  Matrix3 result;
  result << 0, -w.z(), w.y(), w.z(), 0, -w.x(), -k * w.y(), k * w.x(), 0;
  return result;
}

double cone_area(Space space, const std::vector<double>& angles) {
  double curvature = 4 * pi;
  for (const double angle : angles) curvature -= 2 * pi - angle;
  return space.curvature() * curvature;
}

Moduli::Moduli(Space space, std::vector<double> angles) : space_(space), angles_(std::move(angles)) {
  require_surfaces(space_, angles_);
}

double Moduli::area() const { return cone_area(space_, angles_); }

Eigen::Matrix<double, 3, 2> Moduli::frame(const Vector3& p) const {
  return space_.to_origin(p).inverse_matrix().leftCols<2>();
}

std::vector<Isometry> Moduli::rotations(const Points& marks) const {
  std::vector<Isometry> result;
  result.reserve(mark_count());
  for (int i = 0; i < mark_count(); ++i) result.push_back(space_.rotation(marks.row(i), angles_[i]));
  return result;
}

// If w moves p, R moves with it: dR R^-1 = w - R w.
std::vector<VaryingIsometry> Moduli::varying_rotations(const Points& marks) const {
  std::vector<VaryingIsometry> result;
  for (int i = 0; i < mark_count(); ++i) {
    const Vector3 p = marks.row(i);
    const Isometry rotation = space_.rotation(p, angles_[i]);
    const Eigen::Matrix<double, 3, 2> directions = frame(p);
    Eigen::Matrix3Xd rate = Eigen::Matrix3Xd::Zero(3, 2 * mark_count());
    for (int a = 0; a < 2; ++a) {
      const Vector3 w = moving(space_, p, directions.col(a));
      rate.col(2 * i + a) = w - rotation * w;
    }
    result.push_back({rotation, rate});
  }
  return result;
}

Eigen::VectorXd Moduli::closing(const Points& marks) const {
  return infinitesimal_part(space_, product_of(rotations(marks)).matrix()).head(closing_rows(space_));
}

Eigen::MatrixXd Moduli::closing_jacobian(const Points& marks) const {
  VaryingIsometry whole = {Isometry(), Eigen::Matrix3Xd::Zero(3, 2 * mark_count())};
  for (const VaryingIsometry& rotation : varying_rotations(marks)) whole = whole * rotation;
  Eigen::MatrixXd result(closing_rows(space_), 2 * mark_count());
  for (Eigen::Index q = 0; q < result.cols(); ++q) {
    const Matrix3 change = infinitesimal_isometry(space_, whole.rate.col(q)) * whole.value.matrix();
    result.col(q) = infinitesimal_part(space_, change).head(closing_rows(space_));
  }
  return result;
}

Points Moduli::tangents(const Points& marks, const Eigen::VectorXd& step) const {
  Points result(mark_count(), 3);
  for (int i = 0; i < mark_count(); ++i)
    result.row(i) = (frame(marks.row(i)) * step.segment<2>(2 * i)).transpose();
  return result;
}

Eigen::VectorXd Moduli::coordinates(const Points& marks, const Points& tangents) const {
  Eigen::VectorXd result(2 * mark_count());
  for (int i = 0; i < mark_count(); ++i) {
    const Eigen::Matrix<double, 3, 2> directions = frame(marks.row(i));
    for (int a = 0; a < 2; ++a)
      result[2 * i + a] = space_.dot(directions.col(a), tangents.row(i).transpose());
  }
  return result;
}

// The last right singular vectors of [closing_jacobian; isometries; scaling], whose rank is 6.
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
  const std::vector<Isometry> at_best = rotations(best);
  const double scale = std::pow(largest_partial_product(at_best), 2);
  const bool closes = product_of(at_best).difference(Isometry()) < 1e-12 * scale;
  if (!closes || !encloses_area(best)) return std::nullopt;
  return best;
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

// Of the polygon that a cut along the path p_1 .. p_k makes of the surface: p_1 .. p_k, and then, for j = k -
// 1
// .. 2, the later copies (R_(j+1) ... R_k)^-1 p_j. It is met counterclockwise.
bool Moduli::encloses_area(const Points& marks) const {
  if (space_.curvature() == 0) return true;
  std::vector<Vector3> corners;
  corners.reserve(mark_count());
  for (int i = 0; i < mark_count(); ++i) corners.emplace_back(marks.row(i));
  const std::vector<Isometry> rotation = rotations(marks);
  Isometry gluing;
  for (int j = mark_count() - 2; j > 0; --j) {
    gluing = rotation[j + 1] * gluing;
    corners.push_back(gluing.inverse() * Vector3(marks.row(j)));
  }
  double off = -area();
  for (std::size_t c = 1; c + 1 < corners.size(); ++c)
    off += space_.area(corners[0], corners[c], corners[c + 1]);
  if (space_.is_closed()) off = std::remainder(off, 4 * pi);
  return std::abs(off) < 1e-3;
}

Points Moduli::doubled_polygon() const { return InscribedPolygon(space_, angles_).corners(); }

}  // namespace orbitutte
