// SPDX-License-Identifier: MIT
// Area and angle distortion of an embedding (section 6.3).
#pragma once

#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Statistics of area and angle distortion over the faces (section 6.3).
struct Distortion {
  struct Area {
    double mean = 0, std = 0, median = 0, max = 0;
    /// Of max(A, 1/A), A the triangle's share of the tile's area over its share of the source's.
  } area;
  struct Angle {
    double mean = 0, median = 0, max = 0;
    /// The mean weighted by the areas of the source.
    double area_mean = 0;
    /// Of the ratio of singular values of the map to the triangle with the same arc lengths laid out flat.
  } angle;
  /// The part of the source's area that lies in triangles with 1/4 <= A <= 4.
  double within_4 = 0;
  /// The part of the source's area that lies in triangles with A < 1/64.
  double below_64 = 0;
  /// The standard deviation of 1/2 log A, the logarithm of the scale of lengths, weighted by the areas of the
  /// source.
  double sigma = 0;
  struct Histogram {
    /// k + 1 bounds of log2 A, the first and last bins open to all beyond.
    std::vector<double> edges;
    /// k.
    std::vector<long long> counts;
  } histogram;
  /// Those not left out.
  int measured_faces = 0;
};

/// What measure_distortion gathers of a single triangle.
struct FaceDistortion {
  /// The triangle's share of the source's area.
  double share = 0;
  /// A, not max(A, 1/A); 0 where the triangle is left out.
  double area = 0;
  /// The ratio of singular values; 0 where there is none.
  double angle = 0;
};

/// Of every face of the embedding (m).
std::vector<FaceDistortion> measure_triangles(const Surface& surface, const Embedding& embedding);

/// Triangles without area are left out and not counted, and so are images that are not positively oriented or
/// thinner than the rounding errors of positions and their offsets, since their shape is noise. They are
/// neither within_4 nor below_64.
Distortion measure_distortion(const Surface& surface, const Embedding& embedding);

}  // namespace orbitutte
