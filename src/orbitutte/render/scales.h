// SPDX-License-Identifier: MIT
// Which colours distortions have, and the bars that say so.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/render/canvas.h"
#include "orbitutte/verify/distortion.h"

namespace orbitutte {

/// Which colours log2 A has: white at 0, blue where the map shrinks areas, red where it grows them.
struct AreaScale {
  double range = 1;  ///< the strongest colours stand for log2 A <= -range and >= range

  Colour colour(const FaceDistortion& face) const;
};

/// Which colours the ratio of singular values has: pale at 1.
struct AngleScale {
  double largest = 2;  ///< and all above

  Colour colour(const FaceDistortion& face) const;
};

/// Scales that hold nine tenths of the triangles, and for areas up to a factor of 64. log_areas: log2 A.
AreaScale area_scale(const std::vector<double>& log_areas);
AngleScale angle_scale(const std::vector<FaceDistortion>& faces);

/// What A is, on scales and axes; both areas are shares of the whole.
constexpr const char* area_ratio = "image area / mesh area";

/// Where a scale's bar of colours is in its box.
Box scale_bar(const Canvas& canvas, const Box& box);

/// A bar of colours with numbers below it and a title, centred in the box (which should be 4 ems high).
void draw_scale(Canvas& canvas, const Box& box, const AreaScale& scale);
void draw_scale(Canvas& canvas, const Box& box, const AngleScale& scale);

/// The values of log2 A of all faces that are measured.
std::vector<double> log_areas(const std::vector<FaceDistortion>& faces);

/// The value that the share q of all values stays below; 0 where there are none.
double quantile(std::vector<double> values, double q);

/// Whole numbers from -range to range in equal steps, seven at most.
std::vector<int> octaves(double range);

/// "1/8", "1", "8" for -3, 0, 3.
std::string power_of_two(int exponent);

}  // namespace orbitutte
