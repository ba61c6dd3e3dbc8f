// SPDX-License-Identifier: MIT
// Conway's symbols of the spherical orbifolds S^2/G and of the Euclidean ones with the same kinds of marks,
// and what each family asks of a mesh.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// A Conway symbol, read: rotation orders before the first star or cross, corner orders after the star.
struct ConwaySymbol {
  std::vector<int> rotations;
  std::vector<int> corners;
  bool star = false;
  bool cross = false;

  /// One character per order while each is a single digit, commas otherwise; `x` for the cross.
  std::string text() const;
};

/// The signature of fixed boundaries, which no symbol of Conway's is: theorem 1, see polygon.h.
inline const std::string polygon_signature = "polygon";

/// A marked point of the orbifold: the angles around it add up to 2 pi/order, at a corner to pi/order.
struct Mark {
  int order = 1;
  ConeKind kind = ConeKind::rotation;
};

/// A quotient of the sphere by a group of symmetries: what an embedding aims at.
struct Orbifold {
  std::string signature;  ///< canonical text, the orders in the arrangement that was given
  ConwaySymbol symbol;
  int group_order = 1;                   ///< |G|; 0 where it is infinite
  Topology topology = Topology::sphere;  ///< what the mesh has to be
  std::vector<Mark> marks;               ///< in the order in which vertices are marked
  int inner_marks = 0;  ///< so many, the first, lie inside the surface, the others on its boundary
  std::vector<PolygonCorner> corners;  ///< of a fixed polygon, one a mark; otherwise none (polygon.h)
  Geometry geometry = Geometry::spherical;
};

/// Reads a symbol and finds its family. Orders may come in any arrangement.
/// Throws ArgumentError, in one sentence: what is no symbol; what could be read in two ways (both are named);
/// orders that make a Euclidean or hyperbolic orbifold or none at all (teardrops, spindles, order one).
Orbifold parse_orbifold(const std::string& signature);

/// The same for the Euclidean orbifolds of spheres with cones, 333, 442, 632 and 2222, and of disks with
/// corners, *333, *442, *632 and *2222.
Orbifold parse_euclidean_orbifold(const std::string& signature);

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
  std::string family;       ///< "532", "22N", "*NN", ...
  std::string group_order;  ///< "60", "2N", ...
  Topology topology;
  std::string marked_points;
};

/// All families of spherical orbifolds.
std::vector<FamilyDescription> families();

}  // namespace orbitutte
