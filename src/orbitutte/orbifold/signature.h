// SPDX-License-Identifier: MIT
// Conway's symbols of orbifolds, and what each family asks of a mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// Reads a symbol, or `sphere` for 1 and `hemisphere` for *, and finds its family; orders of no family that
/// are large or many enough, without a cross, make a hyperbolic orbifold, whose tile is free. The sign of the
/// orbifold's Euler characteristic decides the space. Orders may come in any arrangement. Throws
/// ArgumentError if the text is not a symbol; if it could be read in two ways (both are named); if the orders
/// make a hyperbolic orbifold with a cross, or none at all (teardrops, spindles, order one); and for
/// Euclidean orbifolds that have no tile here.
Target parse_orbifold(const std::string& signature);

/// What a surface is marked for if no orbifold is named: 222, *222 or 1x.
Target standard_target(Topology topology);

/// Do the marks lie at opposite points of the sphere? They do if there are two and both are alike.
bool are_opposite(const std::vector<Mark>& marks);

/// The angle of each mark in the metric that weights take at cones (sharpened_at_cones), radians; 0 where
/// the mark is no cone. It is the mark's own angle, or twice that if the marks are opposite (are_opposite).
/// Then the map may slide along their axis, and only the error of the linear elements at the cones keeps it
/// in its place. With the marks' own angles nothing would be left of that error, and arcs, which are shorter
/// on the sphere than in the plane, would draw the whole mesh towards one of the cones.
std::vector<double> metric_angles(const std::vector<Mark>& marks);

/// A row of `orbitutte types`.
struct FamilyDescription {
  /// "532", "22N", "*NN", ...
  std::string family;

  /// "60", "2N", "infinite", ...
  std::string group_order;
  Topology topology;
  std::string marked_points;
  Space space;
};

/// All families, those of the sphere first.
std::vector<FamilyDescription> families();

}  // namespace orbitutte
