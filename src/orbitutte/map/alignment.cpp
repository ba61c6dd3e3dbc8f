// SPDX-License-Identifier: MIT
#include "orbitutte/map/alignment.h"

#include <Eigen/LU>
#include <cmath>
#include <complex>

#include "orbitutte/geometry/fitted_rotation.h"
#include "orbitutte/orbifold/symmetry_group.h"

namespace orbitutte {
namespace {

using Complex = std::complex<double>;

// How a group moves the axis through (0, 0, 1).
struct AxisSymmetry {
  int rotations = 0;       // elements that keep orientations and (0, 0, 1)
  bool flips = false;      // does an element exchange above and below?
  Isometry to_other_side;  // one that does
};

AxisSymmetry axis_symmetry(const SymmetryGroup& group) {
  AxisSymmetry result;
  for (const Isometry& g : group.elements()) {
    const double height = (g * Space::origin()).z();
    if (height > 0 && !g.reverses_orientation()) ++result.rotations;
    if (height < 0 && !result.flips) {
      result.flips = true;
      result.to_other_side = g;
    }
  }
  return result;
}

// Distance from the axis times e^(i longitude) of the point or of its image above. If the group has such
// images, the height is a further factor, since on the equator it is uncertain which of them lies above.
Complex seen_from_above(const AxisSymmetry& symmetry, const Vector3& point) {
  const Vector3 p = symmetry.flips && point.z() < 0 ? symmetry.to_other_side * point : point;
  return Complex(p.x(), p.y()) * (symmetry.flips ? std::abs(p.z()) : 1.0);
}

Isometry best_rotation_of_whole_sphere(const Points& from, const Points& to) {
  const FittedRotation rotation = fitted_rotation(from, to);
  if (!(rotation.certainty > 1e-12 * static_cast<double>(from.rows())))
    throw ArgumentError(
        "the points do not say which rotation to take; give points that lie on no line through the centre");
  return Space::sphere().isometry(rotation.matrix);
}

// z^n with the length of z.
Complex turned(const Complex& z, int n) { return std::polar(std::abs(z), n * std::arg(z)); }

}  // namespace

Isometry best_rotation(const Target& target, const Points& from, const Points& to) {
  if (from.rows() != to.rows()) throw ArgumentError("the two lists of points differ in length");
  if (!target.is_free_to_rotate) return {};
  if (target.group_order == 1) return best_rotation_of_whole_sphere(from, to);
  const AxisSymmetry symmetry = axis_symmetry(group_of(target));
  Complex sum = 0;
  for (Eigen::Index k = 0; k < from.rows(); ++k)
    sum += turned(seen_from_above(symmetry, to.row(k)), symmetry.rotations) *
           std::conj(turned(seen_from_above(symmetry, from.row(k)), symmetry.rotations));
  if (!(std::abs(sum) > 1e-12 * static_cast<double>(from.rows())))
    throw ArgumentError("the points do not say by which angle to rotate; give points off the axis");
  return target.space.rotation(Space::origin(), std::arg(sum) / symmetry.rotations);
}

}  // namespace orbitutte
