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
#include <limits>

#include "orbitutte/geometry/precise_isometry.h"
#include "orbitutte/orbifold/families.h"

namespace orbitutte {
namespace {

constexpr double element_tolerance = 1e-9;
constexpr double largest_entry = 1e6;       // of elements far out in the plane
constexpr double line_tolerance = 1e-9;     // points nearer to a line than this lie on it
constexpr double inside_tolerance = 1e-12;  // and points no further outside the chamber than this, in it

void require_near(const Matrix3& element, const Matrix3& isometry, double tolerance) {
  const double off = (element - isometry).cwiseAbs().maxCoeff();
  if (!(off <= tolerance))
    throw ArgumentError(fmt::format("an isometry is no element of the target's group (off by {:.2g})", off));
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

// By how much rounding may move an entry of a product of two in doubles, many factors behind each.
double rounding_of_product(const Matrix3& a, const Matrix3& b) {
  constexpr double part = 1e-12;
  return part * a.cwiseAbs().maxCoeff() * b.cwiseAbs().maxCoeff();
}

}  // namespace

template <typename Real>
PreciseGroup<Real>::PreciseGroup(const Target& target)
    : space_(target.space), lines_(sides_of_chamber<Real>(target)) {
  for (const Vector3Of<Real>& line : lines_) {
    reflections_.push_back(precise_reflection(space_, line));
    rough_lines_.push_back(line.template cast<double>());
    rough_reflections_.push_back(reflections_.back().template cast<double>());
  }
  if (lines_.empty()) {
    know({Isometry(), Matrix3Of<Real>::Identity()});
  } else {
    middle_ = middle_of(space_, rough_lines_);
  }
}

template <typename Real>
PreciseGroup<Real>::PreciseGroup(Space space, const std::vector<PreciseElement<Real>>& generators,
                                 std::vector<Vector3Of<Real>> corners)
    : space_(space), corners_(std::move(corners)) {
  know({Isometry(), Matrix3Of<Real>::Identity()});
  for (const PreciseElement<Real>& generator : generators) know(generator);
}

template <typename Real>
Matrix3Of<Real> PreciseGroup<Real>::element(const Isometry& isometry) const {
  if (!isometry.matrix().allFinite()) throw ArgumentError("an isometry is not finite");
  return lines_.empty() ? found(isometry) : folded(isometry);
}

template <typename Real>
Matrix3Of<Real> PreciseGroup<Real>::folded(const Isometry& isometry) const {
  const Matrix3& matrix = isometry.matrix();
  const double size = std::max(1.0, matrix.cwiseAbs().maxCoeff());
  Matrix3Of<Real> result = Matrix3Of<Real>::Identity();
  if (size <= largest_entry) {
    Vector3 image = isometry * middle_;
    result = product(fold(image));
  }
  require_near(result.template cast<double>(), matrix, element_tolerance * size);
  return result;
}

template <typename Real>
Matrix3Of<Real> PreciseGroup<Real>::found(const Isometry& isometry) const {
  const Matrix3& matrix = isometry.matrix();
  const double size = std::max(1.0, matrix.cwiseAbs().maxCoeff());
  std::size_t nearest = 0;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < known_.size(); ++k) {
    const double off = (known_[k].rough.matrix() - matrix).cwiseAbs().maxCoeff();
    if (off < least) least = off, nearest = k;
  }
  if (least <= element_tolerance * size) return known_[nearest].precise;
  const auto [first, second] = nearest_product(matrix);
  const PreciseElement<Real>&a = known_[first], &b = known_[second];
  require_near((a.rough * b.rough).matrix(), matrix,
               element_tolerance * size + rounding_of_product(a.rough.matrix(), b.rough.matrix()));
  Matrix3Of<Real> result = a.precise * b.precise;
  know({isometry, result});
  return result;
}

// The images of (0, 0, 1) tell most of them apart.
template <typename Real>
typename PreciseGroup<Real>::Factors PreciseGroup<Real>::nearest_product(const Matrix3& matrix) const {
  Factors nearest = {0, 0};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t a = 0; a < known_.size(); ++a) {
    for (std::size_t b = 0; b < known_.size(); ++b) {
      const Matrix3 &first = known_[a].rough.matrix(), &second = known_[b].rough.matrix();
      if ((first * second.col(2) - matrix.col(2)).cwiseAbs().maxCoeff() >= least) continue;
      const double off = (first * second - matrix).cwiseAbs().maxCoeff();
      if (off < least) least = off, nearest = {a, b};
    }
  }
  return nearest;
}

template <typename Real>
void PreciseGroup<Real>::know(const PreciseElement<Real>& element) const {
  known_.push_back(element);
  known_.push_back({element.rough.inverse(), precise_inverse(space_, element.precise)});
}

template <typename Real>
Vector3Of<Real> PreciseGroup<Real>::held_point(const Vector3& point) const {
  const auto distance = [&](const Vector3Of<Real>& corner) {
    return (corner.template cast<double>() - point).cwiseAbs().maxCoeff();
  };
  const auto nearest = std::min_element(corners_.begin(), corners_.end(), [&](const auto& a, const auto& b) {
    return distance(a) < distance(b);
  });
  if (nearest != corners_.end() &&
      distance(*nearest) <= element_tolerance * std::max(1.0, point.cwiseAbs().maxCoeff()))
    return *nearest;
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
  const Vector3Of<Real> here = out.inverse() * point.template cast<Real>(),
                        across = precise_raised(space_, line);
  return out * retract(here - across * (line.dot(here) / line.dot(across)));
}

template <typename Real>
Vector3Of<Real> PreciseGroup<Real>::retract(const Vector3Of<Real>& p) const {
  return precise_retract(space_, p);
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
