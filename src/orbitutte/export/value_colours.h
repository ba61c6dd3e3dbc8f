// SPDX-License-Identifier: MIT
// Values at vertices as colours, to be shown on a surface.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/export/colour.h"
#include "orbitutte/io/vertex_data.h"
#include "orbitutte/types.h"

namespace orbitutte {

/// The colours of a map of values, and what they mean.
struct ValueColours {
  /// n x 3, sRGB, 0 .. 1.
  Points colours;

  /// The values at both ends of the scale; both 0 for labels.
  double low = 0, high = 0;
};

/// The number of the map with this name or, if there is none, of this number, counted from 0. Throws
/// ArgumentError listing the maps.
Eigen::Index find_map(const VertexData& data, const std::string& name_or_number);

/// Labels have the colours of their table. Of measures, the scale spans all but a hundredth of the values at
/// each end: from pale yellow to dark violet; or, if it would contain zero, from blue through white, at zero,
/// to red. Vertices without a label or a finite value are grey.
ValueColours value_colours(const VertexData& data, Eigen::Index map);

/// `count` colours in equal steps along the scale of measures that has these values at its ends.
std::vector<Rgb> value_scale_colours(double low, double high, int count);

}  // namespace orbitutte
