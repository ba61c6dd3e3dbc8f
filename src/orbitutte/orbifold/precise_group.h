// SPDX-License-Identifier: MIT
// The group of a target with as many digits as are wanted.
#pragma once

#include <utility>
#include <vector>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// An element of a group in doubles and with more digits.
template <typename Real>
struct PreciseElement {
  Isometry rough;
  Matrix3Of<Real> precise;
};

/// The elements of a target's group in its canonical frame, and the corners of its tiles, from the marks
/// alone. The group belongs to that of the reflections in the sides of a polygon, the chamber, whose angles
/// are pi/n: every element is the product of the reflections that take a point of its image back into the
/// chamber, so that the product of precise reflections makes it precise, be the group finite or not.
///
/// Rotations about (0, 0, 1), and half turns about x, take the tiles of NN, N* and Nx to other ones and their
/// elements to elements: they may lie turned like that. A fixed polygon has no group but the identity.
///
/// The group of a target whose tile is free depends on the tile, in whatever frame it lies: its generators
/// are given (seam_group.h). It need not be discrete, so that no point says which element took it where it
/// is: an element is looked for among those that are known, which are the generators and all that was asked
/// for, their inverses, and the products of two of these.
/// Real is double or one of the numbers of precise.h.
template <typename Real>
class PreciseGroup {
 public:
  /// If the target's tile is free, the identity alone.
  explicit PreciseGroup(const Target& target);

  /// The group of these elements. corners: the points that held_point is asked for.
  PreciseGroup(Space space, const std::vector<PreciseElement<Real>>& generators,
               std::vector<Vector3Of<Real>> corners);

  /// The element near an isometry. Throws ArgumentError if none is within 1e-9 (its largest entry, relative
  /// to the isometry's), or, of generators that are given, within what the rounding of a product explains: it
  /// is no element, or lies in another frame, or no factor of it was asked for before.
  Matrix3Of<Real> element(const Isometry& isometry) const;

  /// The point near `point` at which every line of reflection that passes within 1e-9 of it meets: a corner
  /// of tiles, a point of a mirror, or a point of the space. Of a vertex that is held where no two lines meet
  /// take one copy's point, and the images of that at the others. If corners are given, the nearest of them
  /// within 1e-9.
  Vector3Of<Real> held_point(const Vector3& point) const;

  /// The point of the space on the line from the origin of R^3 through p.
  Vector3Of<Real> retract(const Vector3Of<Real>& p) const;

 private:
  /// The factors of a product.
  using Factors = std::pair<std::size_t, std::size_t>;

  Matrix3Of<Real> folded(const Isometry& isometry) const;
  Matrix3Of<Real> found(const Isometry& isometry) const;
  Factors nearest_product(const Matrix3& matrix) const;
  void know(const PreciseElement<Real>& element) const;

  /// The sides whose reflections, one after the other, take the point into the chamber; moves it there.
  std::vector<int> fold(Vector3& point) const;

  /// The product of the sides' reflections, the first one on the left.
  Matrix3Of<Real> product(const std::vector<int>& sides) const;

  Space space_;

  /// The sides of the chamber: unit covectors m with m . p >= 0 inside; none if there is no group.
  std::vector<Vector3Of<Real>> lines_;

  std::vector<Matrix3Of<Real>> reflections_;

  /// The same in double, and a point inside the chamber as far from all sides as from any.
  std::vector<Vector3> rough_lines_;
  std::vector<Matrix3> rough_reflections_;
  Vector3 middle_ = Vector3::UnitZ();

  /// If there are no sides: the elements that are known, the identity first, each with its inverse.
  mutable std::vector<PreciseElement<Real>> known_;

  /// The points that were given.
  std::vector<Vector3Of<Real>> corners_;
};

extern template class PreciseGroup<double>;
extern template class PreciseGroup<Precise>;
extern template class PreciseGroup<MorePrecise>;
extern template class PreciseGroup<MostPrecise>;

}  // namespace orbitutte
