// SPDX-License-Identifier: MIT
// How a map deforms a surface, as programs for the cortex measure it: by areas around vertices, by the
// strains J and R of triangles, and by edges. Definitions as of Connectome Workbench's -surface-distortion; J
// and R are those of Robinson et al., Multimodal Surface Matching with higher-order smoothness constraints,
// NeuroImage 167 (2018).
#pragma once

#include <Eigen/Core>
#include <iterator>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/names.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Base-2 logarithms all: 0 where nothing changes, 1 for twice as large.
enum class StrainMeasure {
  /// The area of the triangles around a vertex, image over source.
  area,
  /// J = sigma_1 sigma_2, the area ratio of a triangle; at a vertex the logarithm of the mean over its
  /// triangles.
  j,
  /// R = sigma_1/sigma_2 >= 1, the elongation of a triangle; at a vertex likewise.
  r,
  /// The length of an edge, image over source: the mean of the absolute logarithms of a vertex' edges.
  edge
};

/// Its names.
template <>
struct NameTable<StrainMeasure> {
  static constexpr NamedValue<StrainMeasure> rows[] = {{StrainMeasure::area, "area"},
                                                       {StrainMeasure::j, "J"},
                                                       {StrainMeasure::r, "R"},
                                                       {StrainMeasure::edge, "edge"}};
};

/// How many there are.
constexpr int strain_measures = 4;

struct StrainMap {
  /// A row for each vertex or face, a column for each StrainMeasure in its order; 0 where nothing was
  /// measured.
  Eigen::Matrix<double, Eigen::Dynamic, strain_measures> values;

  /// A row each: was it measured? Not, if no face with an area in source and image is there.
  std::vector<char> measured;
};

/// What a StrainMap says of a measure.
struct StrainStatistics {
  double mean = 0, mean_absolute = 0;

  /// The values that so many percent do not exceed: 1, 5, 25, 50, 75, 95 and 99.
  static constexpr int percents[] = {1, 5, 25, 50, 75, 95, 99};
  double percentiles[std::size(percents)] = {};
};

struct SurfaceStrain {
  /// n rows, of the input's vertices.
  StrainMap at_vertices;

  /// m rows, of the input's faces; area and J are the same there, and polygons are measured by their
  /// triangles.
  StrainMap on_faces;
};

/// Measures the map from the surface to the flat triangles between the images of its vertices, which are
/// scaled first: to the sphere of the given radius, or, if that is 0, to the area of the surface. Faces that
/// are not positively oriented, or whose image is lost in rounding (measure_triangles), are left out.
SurfaceStrain measure_strain(const Surface& surface, const Embedding& embedding, double radius = 0);

/// By StrainMeasure; over the rows that were measured. All 0 if there are none.
std::vector<StrainStatistics> strain_statistics(const StrainMap& map);

}  // namespace orbitutte
