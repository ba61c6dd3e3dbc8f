// SPDX-License-Identifier: MIT
// Cones whose angles, and places if wanted, distort a surface least: what may be asked for, and what is
// found.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte {

class ScaleKernel;

/// What is asked of the angles.
struct FitOptions {
  /// The area of the target times its curvature, by Gauss and Bonnet: above 0 it is spherical, below 0
  /// hyperbolic, 0 flat. If not given, the area is fitted, too.
  std::optional<double> area = 0;

  /// Shares of the angle that a vertex has where it is no cone (2 pi inside, pi on the boundary). If the
  /// greatest is not given, it is 1.95 for flat targets, since gluings do not tell a cone of 4 pi from an
  /// ordinary point, and 0.99 for others, whose angles stay below 2 pi.
  double least_angle = 0.05;
  std::optional<double> greatest_angle = {};

  /// The triangles around a cone are stretched as much as its angle differs from theirs. A small angle
  /// is therefore made larger until they have no more than this share of the target's area and add no more
  /// than this excess to E/2A (by their stretch in the surface's own metric), unless sigma would grow by more
  /// than the part `sigma_for_shares`; then until it has grown by the part `sigma_in_vain`. A share of 1 and
  /// an infinite excess keep the angles of least sigma.
  double greatest_share = 0.03, greatest_excess = 0.05;
  double sigma_for_shares = 0.1, sigma_in_vain = 0.01;

  double greatest() const { return greatest_angle.value_or(area && *area == 0 ? 1.95 : 0.99); }
};

/// The angles of cones, in their order, and what they are expected to cost.
struct FittedAngles {
  /// Radians.
  std::vector<double> angles;

  /// Curvature times area of the target.
  double area = 0;

  /// Of the logarithm of the scale, by the Laplacian: exact up to the mesh for flat targets, and for curved
  /// ones to first order in their curvature.
  double sigma = 0;
};

/// Which cones are wanted.
struct ConeWishes {
  /// How many, those that are kept included. If `sigma` is given, at least so many.
  int count = 3;

  /// As few cones as reach it, if given.
  std::optional<double> sigma;

  /// Vertices that are cones in any case.
  std::vector<int> kept;

  FitOptions fit;

  /// Are the angles to be those of an orbifold, 2 pi/n, and pi/n at corners? Their area is then their own.
  bool are_orders = false;
};

/// Are there more cones than those that are kept?
inline bool are_placed(const ConeWishes& wishes) {
  return wishes.sigma || wishes.count > static_cast<int>(wishes.kept.size());
}

/// Cones and their angles.
struct FittedCones {
  /// The kept ones first, then the others, the most curved first.
  std::vector<int> vertices;
  FittedAngles fit;
};

/// The cones for a surface: at the kept vertices alone if `count` is not above their number and `sigma` not
/// given, otherwise at the best that are found (place_cones). weights: those of the Laplacian. On a disk,
/// those inside come first, and then those on the boundary as it meets them. Throws MeshError if a kept
/// vertex is no vertex of a face or is given twice, if no such angles have the area, if the surface is
/// neither a sphere nor a disk, and if `sigma` is out of reach.
FittedCones find_cones(const Surface& surface, const ConeWishes& wishes, const WeightOptions& weights = {});

/// The same for several wishes, by one factorisation of the Laplacian of a sphere or disk.
FittedCones find_cones(const ScaleKernel& kernel, const ConeWishes& wishes);

}  // namespace orbitutte
