// SPDX-License-Identifier: MIT
// Conway's symbols of orbifolds, and what each family asks of a mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/target.h"

namespace orbitutte {

/// Reads a symbol and finds its family; the sign of the orbifold's Euler characteristic decides the space.
/// Orders may come in any arrangement. Throws ArgumentError, in one sentence: what is no symbol; what could
/// be read in two ways (both are named); orders that make a hyperbolic orbifold or none at all (teardrops,
/// spindles, order one), and Euclidean ones that have no tile here.
Target parse_orbifold(const std::string& signature);

/// Do the marks lie at opposite points of the sphere? Two alike do, if they are all there are.
bool are_opposite(const std::vector<Mark>& marks);

/// The angle of each mark in the metric that weights take at cones (sharpened_at_cones), radians; 0 where the
/// mark is no cone. It is the mark's own, but twice that where two alike are all there are: these lie
/// opposite to each other, and the map may slide along their axis at no cost but the error of the elements
/// there. With their own angles nothing would be left of that, and arcs, shorter than the plane's, would draw
/// the whole mesh towards one of them.
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
