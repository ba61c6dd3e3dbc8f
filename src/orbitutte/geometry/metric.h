// SPDX-License-Identifier: MIT
// Lengths, areas and angles of either geometry.
#pragma once

#include "orbitutte/geometry/geometry.h"

namespace orbitutte {

struct Metric {
  double (*length)(const Vector3& p, const Vector3& q);                  ///< between two points
  double (*area)(const Vector3& a, const Vector3& b, const Vector3& c);  ///< of a triangle, signed
  double (*angle)(const Vector3& p, const Vector3& q,
                  const Vector3& r);  ///< at p, from q counterclockwise to r
};

/// Arcs, solid angles and angles of the unit sphere (spherical_triangle.h), or those of the plane z = 1.
const Metric& metric_of(Geometry geometry);

}  // namespace orbitutte
