// SPDX-License-Identifier: MIT
// Pictures as arrays of pixels.
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

/// Every pixel is colour(column, row). Pixels are independent, rows run on all threads.
Image picture_of(const PictureSize& size, const std::function<Rgba(int column, int row)>& colour);

}  // namespace orbitutte
