// SPDX-License-Identifier: MIT
// Distortions of several maps of one mesh side by side (section 6.3, figure 12).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// A map of the mesh.
struct ComparedMap {
  /// "sphere: 432"
  std::string title;
  /// Of max(A, 1/A), as measure_distortion has it.
  Distortion::Area area;
  /// m, as measure_triangles has them.
  std::vector<FaceDistortion> faces;
};

struct Comparison {
  const Surface& surface;
  /// The marked vertices, which should be visible.
  std::vector<int> cones;
  std::vector<ComparedMap> maps;
  /// Towards the viewer; without: whichever shows most.
  std::optional<Vector3> view;
  /// What points up; without: y or z, whichever the mesh stands on.
  std::optional<Vector3> up;
};

/// Draws the maps next to each other: the mesh in the colours of area distortion and of angle distortion
/// (.png only), and below it the histogram of areas. All have the same colour scales, bins and axes. The same
/// input gives the same bytes. The file appears whole or not at all. Throws ArgumentError for another ending
/// than .png or .svg, FileError.
void write_comparison(const std::string& path, const Comparison& comparison);

}  // namespace orbitutte
