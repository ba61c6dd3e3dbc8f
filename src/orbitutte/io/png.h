// SPDX-License-Identifier: MIT
// PNG as arrays of numbers: for values, where pictures would do.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// Row by row from the top left, the channels of a pixel after each other.
struct PngPixels {
  int width = 0, height = 0;

  /// 1 (grey) or 3 (red, green, blue).
  int channels = 1;

  /// 0 .. 65535, whatever the depth of the file.
  std::vector<std::uint16_t> values;
};

/// A file of 8 bits a channel, which have the high bytes of the values, or of 16.
enum class PngDepth { eight = 8, sixteen = 16 };
std::string serialize_png(const PngPixels& pixels, PngDepth depth);

/// Of any PNG; an opacity is left out. Values of fewer bits are scaled to 0 .. 65535. Throws MeshError if the
/// bytes are no PNG, or damaged.
PngPixels parse_png(std::string_view bytes);

}  // namespace orbitutte
