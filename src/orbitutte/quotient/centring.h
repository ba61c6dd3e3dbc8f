// SPDX-License-Identifier: MIT
// Which of all Möbius maps a map to the whole sphere, or to a hemisphere, is followed by.
#pragma once

#include <vector>

#include "orbitutte/geometry/precise.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/options.h"
#include "orbitutte/quotient/moebius.h"

namespace orbitutte {

/// The images of a surface's vertices, and what they are judged by.
struct SphereImages {
  const Surface& surface;

  /// n: of the input vertices.
  std::vector<ChartPoint> points;

  /// What the map must keep: the projection onto the vectors that the target's group fixes. The identity for
  /// the whole sphere; for a hemisphere it takes away what is across its mirror.
  Matrix3 fixed = Matrix3::Identity();
};

/// Where a Möbius map takes the chart's points on the unit sphere (n x 3).
Points positions_after(const Moebius& moebius, const std::vector<ChartPoint>& points);

/// The shares of the vertices: by area, a third of the faces' areas around each, or all alike. They add up to
/// 1; vertices that no face uses have none.
Eigen::VectorXd vertex_shares(const Surface& surface, Centre centre);

/// Newton's step towards where the sum of shares * positions, its part among the vectors that `fixed`
/// projects onto, vanishes: the velocity of a boost.
Vector3 step_to_centre(const Points& positions, const Eigen::VectorXd& shares, const Matrix3& fixed);

/// A point of the sphere moved by the boost of a velocity v, from v/|v| tanh(|v|/2): the rational map
/// p -> b + (1 - <b, b>) (p + b)/<p + b, p + b>, which has as many digits as Real.
template <typename Real>
Vector3Of<Real> boosted(const Vector3& half_way, const Vector3Of<Real>& point) {
  const auto b = half_way.cast<Real>().eval();
  const Vector3Of<Real> sum = point + b;
  const Real scale = (Real(1) - b.dot(b)) / sum.dot(sum);
  return b + scale * sum;
}

/// v/|v| tanh(|v|/2): where the boost takes the centre of the ball.
Vector3 half_way_of(const Vector3& velocity);

/// The Möbius map after which the images are centred as `centre` says:
/// - area, vertices: the sum of shares * positions (with its copies by the group) vanishes. It is the minimum
///   of a convex function, so that there is exactly one up to rotations, as long as no point has a share of
///   one half (A. Baden, K. Crane, M. Kazhdan, "Möbius registration", 2018; J. Cantarella, H. Schumacher,
///   "Computing the conformal barycenter", 2022);
/// - sigma: the logarithm of the scale of lengths has the least variance over the surface's area;
/// - none: the identity.
Moebius centring(const SphereImages& images, Centre centre);

}  // namespace orbitutte
