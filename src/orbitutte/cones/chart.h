// SPDX-License-Identifier: MIT
// The conformal chart of a whole surface that one map to the orbifold 222 or *222 gives: its group's
// invariant.
#pragma once

#include <memory>

#include "orbitutte/cones/precise_complex.h"
#include "orbitutte/orbifold/exact_positions.h"

namespace orbitutte {

/// A point of the Riemann sphere, numerator : denominator, of which the larger is 1.
struct PreciseChartPoint {
  PreciseComplex numerator, denominator;
};

/// The same in doubles; `precise` where doubles do not tell it from other points of the surface.
struct ChartPoint {
  Complex numerator, denominator;
  std::shared_ptr<const PreciseChartPoint> precise;
};

/// The point numerator : denominator, neither larger than 1 and one of them 1, with all digits.
ChartPoint exact_point(double numerator, double denominator);

/// n_a d_b - n_b d_a: zero if the points are the same, and right to some 1e-6 of itself however near they
/// are.
Complex bracket(const ChartPoint& a, const ChartPoint& b);

/// The mirror image in the real line.
ChartPoint conjugate(const ChartPoint& point);

/// (x, y, z) on the unit sphere with (x + iy)/(1 + z) = numerator/denominator: 0 at (0, 0, 1), infinity at
/// (0, 0, -1), 1 at (1, 0, 0). Seen from outside, the sphere has the orientation of the complex plane.
Vector3 sphere_point(const ChartPoint& point);

/// Is the target 222 or *222, so that a map to it gives a chart?
bool has_orbifold_chart(const Target& target);

/// With w = (x + iy)/(1 + z) on the sphere of the embedding, in the canonical frame, the group of 222 (half
/// turns about the axes) is that of w -> -w, 1/w, -1/w. Its invariant
///     Z = (w^2 + 1)^2 / (4 w^2)
/// takes each orbit to one point: a conformal chart of the whole surface, of degree one and with its
/// orientation, which lays the marks 0, 1 and 2 at infinity, 1 and 0. A map of a disk to *222 is half of the
/// map of its double to 222: Z takes the disk to one side of the real line, its boundary to the line, and the
/// other half of the double to conjugates.
class OrbifoldChart {
 public:
  /// Refers to the embedding. Throws ArgumentError unless has_orbifold_chart holds for its target.
  explicit OrbifoldChart(const Embedding& embedding);

  /// Of a cut vertex: the same for all copies of a vertex, up to rounding.
  ChartPoint of_vertex(int v) const;

  /// Of the middle of a triangle of the embedding.
  ChartPoint of_triangle(int f) const;

 private:
  /// Can doubles not tell the vertex from its neighbours, in the frame where 1 is added to coordinates?
  bool needs_digits(int v) const;

  Vector3Of<Precise> precise_position(int v) const;

  const Embedding& embedding_;
  ExactPositions positions_;
  Matrix3 to_canonical_;
};

}  // namespace orbitutte
