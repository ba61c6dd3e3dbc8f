// SPDX-License-Identifier: MIT
// The quotient of a map to an orbifold by its group: a conformal map to the whole sphere, or to a hemisphere.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/options.h"
#include "orbitutte/orbifold/embedding.h"
#include "orbitutte/quotient/moebius.h"

namespace orbitutte {

/// The target onto whose whole the quotient is: 1 if the surface is a sphere, * if it is a disk. Throws
/// ArgumentError unless the quotients of maps to `base` are known: those to NN, *NN and N* (z^N), 222 and
/// *222 (OrbifoldChart).
Target quotient_target(const Target& base);

/// The target with marks from whose map that to 1 or * is made: 222 or *222.
Target quotient_base(const Target& whole);

/// Throws MeshError naming a vertex that is to be held but is none of the surface, or not on the boundary of
/// a disk; ArgumentError for points that no map to `onto` (1 or *) has there.
void require_points(const Surface& surface, const Target& onto, const std::vector<PolygonCorner>& points);

/// The quotient of a map by its group, followed by the Möbius map that the options ask for: where it has the
/// input vertices. It has the surface's orientation; that onto a hemisphere lies above z = 0 and has the
/// boundary on it, up to rounding.
class QuotientMap {
 public:
  /// `onto` is 1 or *. Throws as require_points, and ArgumentError if points on the equator run the other way
  /// around it than the boundary.
  QuotientMap(const Surface& surface, const Embedding& base, const Target& onto,
              const QuotientOptions& options);

  /// n x 3.
  Points positions() const;

  /// With as many digits as the map that it was made from has there.
  Vector3Of<Precise> precise_position(int v) const { return moebius_.precise_image(chart_[v]); }

 private:
  /// The chart's points of the input vertices.
  std::vector<ChartPoint> chart_;
  Moebius moebius_;
};

/// Moves an embedding onto 1 or * that is almost centred, offsets included, by the Möbius map that centres
/// the area or the vertices; not at all for other kinds of centre.
void centre_anew(const Surface& surface, Centre centre, Embedding& embedding);

/// Of an embedding onto 1 or *: how far the centre of mass, of area or vertices, is from where it has to be.
double distance_from_centre(const Surface& surface, Centre centre, const Embedding& embedding);

}  // namespace orbitutte
