// SPDX-License-Identifier: MIT
// Pictures as arrays of pixels, and how samples make them.
#pragma once

#include <functional>
#include <vector>

#include "orbitutte/export/colour.h"

namespace orbitutte {

/// In pixels.
struct PictureSize {
  int width = 0;
  int height = 0;

  bool operator==(const PictureSize&) const = default;
};

/// Red, green, blue in linear light, times the coverage, and the coverage 0 .. 1.
using Rgba = Eigen::Array4f;

inline Rgba opaque(const Colour& colour) { return {colour[0], colour[1], colour[2], 1}; }

struct Image {
  PictureSize size;
  /// Row by row from the top left.
  std::vector<Rgba> pixels;

  const Rgba& at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * size.width + column];
  }
};

/// Where a sample lies: x to the right and y down, in pixels from the top left corner of the picture.
struct Sample {
  float x = 0;
  float y = 0;
  /// In the pixel, 0 .. samples_across^2 - 1.
  int number = 0;
};

/// The number of samples along each side of a pixel.
constexpr int samples_across = 3;

/// Every pixel is the mean of shade(sample) over a grid of samples. Pixels are independent, rows run on all
/// threads.
Image supersample(const PictureSize& size, const std::function<Rgba(const Sample&)>& shade);

}  // namespace orbitutte
