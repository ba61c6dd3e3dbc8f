// SPDX-License-Identifier: MIT
// The values of distortion that a scale of colours spans, and the text beside it.
#pragma once

#include <vector>

#include "orbitutte/report/chart.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// What is measured of a face. Scales run over log2 of the area ratio A, and over the angle distortion
/// itself.
enum class Measure { area, angle };

/// The face's value on scales and axes; NaN if it is not measured.
double value_of(Measure measure, const FaceDistortion& face);

/// The values of all faces that are measured.
std::vector<double> values_of(Measure measure, const std::vector<FaceDistortion>& faces);

/// A bar of colours with an axis below it: scale_colour (export/palette.h) has the colours. What lies beyond
/// an end has the colour of that end.
struct ColourScale {
  Measure measure = Measure::area;
  ChartAxis axis;
};

/// The scale that holds nine tenths of these values if they are areas (up to a factor of 64), and 95 % if
/// they are angles (up to a ratio of 10). Its end is one of a few round numbers.
ColourScale colour_scale(Measure measure, const std::vector<double>& values);

/// The scale that all maps share (values of each): the widest that one of them needs.
ColourScale common_colour_scale(Measure measure, const std::vector<std::vector<double>>& maps);

}  // namespace orbitutte
