// SPDX-License-Identifier: MIT
// The group that the seams of a cut surface generate, with as many digits as are wanted.
#pragma once

#include <boost/math/constants/constants.hpp>
#include <functional>
#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/orbifold/precise_group.h"

namespace orbitutte {

/// The angle of a mark: with all digits if it is the double nearest to 2 pi/n or pi/n, otherwise the double.
template <typename Real>
Real precise_angle(const Mark& mark) {
  const int order = mark.order();
  if (order == 0 || Mark::of_order(order, mark.kind).angle != mark.angle) return mark.angle;
  const Real& pi = boost::math::constants::pi<Real>();
  return mark.kind == ConeKind::corner ? Real(pi / order) : Real(2 * pi / order);
}

/// The boundary of a cut mesh, which was cut along a tree: its marks, and how it is glued.
template <typename Real>
struct GluedBoundary {
  /// The cut vertices around it, counterclockwise. It begins on a sphere at the first of the cones, on a disk
  /// at a corner, or, if there is none, where a mirror ends.
  std::vector<int> loop;
  /// n_cut: the input vertex.
  const std::vector<int>& source_vertex;
  const std::vector<Seam>& seams;
  const std::vector<ConeCopies>& cones;
  /// Where a cut vertex lies: asked for of the copies of the marks, and of the first vertex of the loop, that
  /// the loop meets first.
  std::function<Vector3Of<Real>(int)> position;
};

/// The group of a target. If its tile is free, the group is what the positions of the marks make it:
///
/// Let R_k be the rotation by the angle of the cone that the loop meets as the k-th, about the copy that it
/// meets first. The gluing of a seam is the product R_i ... R_j of those that are met between its banks
/// (free_tile.h). On a sphere, where the product of all has to be the identity, the positions are corrected
/// by what rounding left, as little as possible. A mirror is the line through the corners at its ends, also
/// if cuts end on it, whose far sides are seen through their gluings. So the group's relations hold to the
/// last digit, but for the angles of corners, which are those of the lines.
template <typename Real>
PreciseGroup<Real> group_of_boundary(const Target& target, const GluedBoundary<Real>& boundary);

extern template PreciseGroup<Precise> group_of_boundary(const Target&, const GluedBoundary<Precise>&);
extern template PreciseGroup<MorePrecise> group_of_boundary(const Target&, const GluedBoundary<MorePrecise>&);
extern template PreciseGroup<MostPrecise> group_of_boundary(const Target&, const GluedBoundary<MostPrecise>&);

}  // namespace orbitutte
