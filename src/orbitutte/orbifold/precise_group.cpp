// SPDX-License-Identifier: MIT
// The words of elements after J. E. Humphreys, "Reflection groups and Coxeter groups" (1990), section 1.12:
// the chambers are permuted simply transitively, and a reflection in a side that separates a point from the
// chamber brings it nearer.
#include "orbitutte/orbifold/precise_group.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <boost/math/constants/constants.hpp>
#include <cmath>

#include "orbitutte/orbifold/families.h"

namespace orbitutte {
namespace {

constexpr double element_tolerance = 1e-9;
constexpr double largest_entry = 1e6;       // of elements far out in the plane
constexpr double line_tolerance = 1e-9;     // points nearer to a line than this lie on it
constexpr double inside_tolerance = 1e-12;  // and points no further outside the chamber than this, in it

// J m, with J = diag(1, 1, k): where the reflection in the line moves points.
template <typename Real>
Vector3Of<Real> raised(Space space, const Vector3Of<Real>& line) {
  return {line.x(), line.y(), space.curvature() * line.z()};
}

// The sides of the triangle with the angles pi/n[k], as canonical_triangle lays it: the side between corners
// 0 and 1 is the line y = 0, that between 0 and 2 passes through the origin at the angle of corner 0. Their
// products are -cos(pi/n) where they meet, which gives the third's x and y; its z makes it a unit, or, in the
// plane, has it pass through corner 1.
template <typename Real>
std::vector<Vector3Of<Real>> sides_of_triangle(Space space, const std::vector<int>& n) {
  using std::cos, std::sin, std::sqrt;
  const Real& pi = boost::math::constants::pi<Real>();
  const Real a = pi / n[0], b = pi / n[1], c = pi / n[2];
  const Real x = (-cos(c) - cos(a) * cos(b)) / sin(a), y = -cos(b);
  const int k = space.curvature();
  const Real z = k == 0 ? Real(-x * sin(c)) : Real(sqrt(Real(k * (1 - x * x - y * y))));
  return {{Real(0), Real(1), Real(0)}, {sin(a), -cos(a), Real(0)}, {x, y, z}};
}

template <typename Real>
std::vector<Vector3Of<Real>> sides_of_chamber(const Target& target) {
  if (!target.corners.empty() || target.has_free_tile) return {};
  const Family* family = find_family(target.symbol);
  return family ? sides_of_triangle<Real>(target.space, family->chamber(target))
                : std::vector<Vector3Of<Real>>();
}

// The point as far from all three sides, m . p the same for all.
Vector3 middle_of(Space space, const std::vector<Vector3>& lines) {
  Matrix3 rows;
  for (int i = 0; i < 3; ++i) rows.row(i) = lines[i];
  return space.retract(rows.fullPivLu().solve(Vector3::Ones()));
}

// 1 - 2 m# m^T/(m . m#).
template <typename Real>
Matrix3Of<Real> reflection(Space space, const Vector3Of<Real>& line) {
  const Vector3Of<Real> moved = raised(space, line);
  const Real scale = Real(2) / line.dot(moved);
  return Matrix3Of<Real>::Identity() - scale * (moved * line.transpose());
}

}  // namespace

template <typename Real>
PreciseGroup<Real>::PreciseGroup(const Target& target)
    : space_(target.space), lines_(sides_of_chamber<Real>(target)) {
  for (const Vector3Of<Real>& line : lines_) {
    reflections_.push_back(reflection(space_, line));
    rough_lines_.push_back(line.template cast<double>());
    rough_reflections_.push_back(reflections_.back().template cast<double>());
  }
  if (!lines_.empty()) middle_ = middle_of(space_, rough_lines_);
}

template <typename Real>
Matrix3Of<Real> PreciseGroup<Real>::element(const Isometry& isometry) const {
  const Matrix3& matrix = isometry.matrix();
  const double size = std::max(1.0, matrix.cwiseAbs().maxCoeff());
  Matrix3Of<Real> result = Matrix3Of<Real>::Identity();
  if (matrix.allFinite() && size <= largest_entry) {
    Vector3 image = isometry * middle_;
    result = product(fold(image));
  }
  const double off = (result.template cast<double>() - matrix).cwiseAbs().maxCoeff();
  if (!(off <= element_tolerance * size))
    throw ArgumentError(fmt::format("an isometry is no element of the target's group (off by {:.2g})", off));
  return result;
}

template <typename Real>
Vector3Of<Real> PreciseGroup<Real>::held_point(const Vector3& point) const {
  Vector3 folded = point;
  const Matrix3Of<Real> out = product(fold(folded));
  std::vector<int> through;
  for (int i = 0; i < static_cast<int>(lines_.size()); ++i)
    if (std::abs(rough_lines_[i].dot(folded)) < line_tolerance) through.push_back(i);
  if (through.empty()) return retract(point.template cast<Real>());
  if (through.size() > 1) {
    const Vector3Of<Real> corner = retract(lines_[through[0]].cross(lines_[through[1]]));
    const bool is_opposite = corner.template cast<double>().dot(folded) < 0;
    return out * (is_opposite ? Vector3Of<Real>(-corner) : corner);
  }
  const Vector3Of<Real>& line = lines_[through[0]];
  const Vector3Of<Real> here = out.inverse() * point.template cast<Real>(), across = raised(space_, line);
  return out * retract(here - across * (line.dot(here) / line.dot(across)));
}

// k (x^2 + y^2) + z^2 = 1 there.
template <typename Real>
Vector3Of<Real> PreciseGroup<Real>::retract(const Vector3Of<Real>& p) const {
  using std::sqrt;
  if (space_.curvature() == 0) return p / p.z();
  return p / Real(sqrt(Real(space_.curvature() * (p.x() * p.x() + p.y() * p.y()) + p.z() * p.z())));
}

template <typename Real>
std::vector<int> PreciseGroup<Real>::fold(Vector3& point) const {
  std::vector<int> sides;
  const auto outermost = [&] {
    int side = -1;
    double least = -inside_tolerance * std::max(1.0, point.cwiseAbs().maxCoeff());
    for (int i = 0; i < static_cast<int>(rough_lines_.size()); ++i) {
      const double height = rough_lines_[i].dot(point);
      if (height < least) {
        least = height;
        side = i;
      }
    }
    return side;
  };
  for (int side = outermost(); side >= 0; side = outermost()) {
    sides.push_back(side);
    point = rough_reflections_[side] * point;
  }
  return sides;
}

template <typename Real>
Matrix3Of<Real> PreciseGroup<Real>::product(const std::vector<int>& sides) const {
  Matrix3Of<Real> result = Matrix3Of<Real>::Identity();
  for (const int side : sides) result = result * reflections_[side];
  return result;
}

template class PreciseGroup<double>;
template class PreciseGroup<Precise>;
template class PreciseGroup<MorePrecise>;
template class PreciseGroup<MostPrecise>;

}  // namespace orbitutte
