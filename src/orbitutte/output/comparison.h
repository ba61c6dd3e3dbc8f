// SPDX-License-Identifier: MIT
// Distortions of several maps of one mesh side by side (section 6.3, figure 12).
#pragma once

#include <string>
#include <vector>

#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// A map's name and the distortion of each of its faces (measure_faces).
struct ComparedMap {
  std::string title;
  std::vector<FaceDistortion> faces;
};

/// Writes the histograms of area distortion next to each other, as .png or .svg. The file appears whole or
/// not at all. Throws ArgumentError for another ending, FileError.
void write_comparison(const std::string& path, const std::vector<ComparedMap>& maps);

}  // namespace orbitutte
