// SPDX-License-Identifier: MIT
// PNG as arrays of numbers: values, where pictures would do, and the pictures of io/image_file.h.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// Larger pictures are refused before memory is taken for them.
inline constexpr int longest_picture_side = 32768;

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

/// The same pixels give the same bytes. Throws ArgumentError if there are no pixels, more or fewer than width
/// times height, or other channels than 1 or 3.
std::string serialize_png(const PngPixels& pixels, PngDepth depth);

/// Of any PNG; an opacity is left out. Values of fewer bits are scaled to 0 .. 65535, and are otherwise those
/// of the file, whatever it says about its colours. Throws MeshError if the bytes are no PNG, damaged or cut
/// short, or have a side longer than longest_picture_side.
PngPixels parse_png(std::string_view bytes);

/// What is known of the pixels before they are read.
struct PngLayout {
  int width = 0, height = 0;

  /// 1 (grey), 3 (red, green, blue) or 4 (with opacity).
  int channels = 1;
};

/// Of any PNG; the channels are those that parse_png would give. Throws MeshError as it does.
PngLayout parse_png_layout(std::string_view bytes);

/// Of any PNG as red, green, blue (sRGB, for which the gamma of the file is taken into account) and opacity,
/// 0 .. 255 each. Throws MeshError as parse_png, and ArgumentError if there is not room for exactly 4 x width
/// x height.
void parse_png_colours(std::string_view bytes, std::span<std::uint8_t> colours);

/// A PNG of sRGB colours, 0 .. 255 each. Throws ArgumentError as serialize_png.
std::string serialize_png_colours(const PngLayout& layout, std::span<const std::uint8_t> colours);

}  // namespace orbitutte
