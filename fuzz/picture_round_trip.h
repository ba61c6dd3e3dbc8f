// SPDX-License-Identifier: MIT
// What has to hold for any bytes given to the readers of PNG. The fuzz target and the test that replays its
// corpus both check it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <string_view>

#include "../tests/png_checksum.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/image_file.h"
#include "orbitutte/io/png.h"
#include "round_trip.h"

namespace orbitutte::fuzz {

/// The bytes with the checksum that each chunk should have: otherwise hardly any change would get past it.
inline std::string with_right_checksums(std::string bytes) {
  constexpr std::size_t signature = 8, around = 12;  // length, type and checksum
  for (std::size_t at = signature; at + around <= bytes.size();) {
    const auto size = load<std::uint32_t>(bytes.data() + at, std::endian::big);
    if (size > bytes.size() - at - around) break;
    std::string checksum;
    append_big_endian(checksum, test::png_checksum(std::string_view(bytes).substr(at + 4, size + 4)));
    bytes.replace(at + 8 + size, 4, checksum);
    at += around + size;
  }
  return bytes;
}

inline void check_accepted_values_of_png(std::string_view bytes) {
  const PngPixels pixels = parse_png(bytes);
  const PngPixels again = parse_png(serialize_png(pixels, PngDepth::sixteen));
  require(pixels.width == again.width && pixels.height == again.height && pixels.channels == again.channels,
          "a PNG keeps its shape");
  require(pixels.values == again.values, "the values of a PNG come back");
}

inline void check_accepted_picture(std::string_view bytes) {
  const PixelImage image = parse_image(bytes);
  const PixelImage again = parse_image(png_bytes(image));
  require(image.width == again.width && image.height == again.height, "a picture keeps its shape");
  require(image.pixels == again.pixels, "the pixels of a picture come back");
}

/// Throws std::logic_error, or whatever the readers throw by mistake, where a property is violated. Pictures
/// in other formats are left alone.
inline void check_picture_round_trip(std::string_view bytes) {
  check_or_refuse([&] { check_accepted_values_of_png(bytes); });
  if (!bytes.starts_with("\x89PNG")) return;
  try {
    check_accepted_picture(bytes);
  } catch (const FileError& error) {
    check_message(error.what());
  }
}

}  // namespace orbitutte::fuzz
