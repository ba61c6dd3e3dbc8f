// SPDX-License-Identifier: MIT
// Pictures as files: PNG (io/png.h) and JPEG (TurboJPEG) are read, PNG is written.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// Red, green, blue (sRGB) and opacity, 0 .. 255 each.
using Pixel = std::array<std::uint8_t, 4>;

/// A picture as files have it.
struct PixelImage {
  int width = 0, height = 0;

  /// height x width, row by row from the top left.
  std::vector<Pixel> pixels;

  const Pixel& at(int column, int row) const {
    return pixels[static_cast<std::size_t>(row) * width + column];
  }
};

/// The picture in the bytes of a PNG or JPEG file, of any depth and kind of colours; the first bytes say
/// which. Throws FileError if they are neither, damaged, or larger than 32,768 pixels along a side.
PixelImage parse_image(std::string_view bytes);

/// The same of a file. Messages begin with the path. Throws FileError.
PixelImage read_image(const std::string& path);

/// The bytes of a PNG, without opacity if every pixel is opaque. The same picture gives the same bytes.
/// Throws ArgumentError if there are no pixels, or more or fewer than width times height.
std::string png_bytes(const PixelImage& image);

}  // namespace orbitutte
