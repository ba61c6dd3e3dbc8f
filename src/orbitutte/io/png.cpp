// SPDX-License-Identifier: MIT
// PNG (ISO/IEC 15948): written by hand, read by stb_image.
#include "orbitutte/io/png.h"

#include <fmt/format.h>
#include <zlib.h>

#include <limits>
#include <memory>

#include "orbitutte/io/compression.h"
#include "orbitutte/types.h"

#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#define STBI_NO_STDIO
#include <stb_image.h>

namespace orbitutte {
namespace {

struct FreeStb {
  void operator()(stbi_us* pixels) const { stbi_image_free(pixels); }
};

void append_big_endian(std::string& bytes, std::uint32_t number) {
  for (int shift = 24; shift >= 0; shift -= 8) bytes += static_cast<char>(number >> shift & 0xff);
}

void append_png_chunk(std::string& bytes, std::string_view type, std::string_view content) {
  append_big_endian(bytes, static_cast<std::uint32_t>(content.size()));
  std::string chunk(type);
  chunk += content;
  bytes += chunk;
  append_big_endian(bytes, static_cast<std::uint32_t>(
                               crc32_z(0, reinterpret_cast<const Bytef*>(chunk.data()), chunk.size())));
}

}  // namespace

std::string serialize_png(const PngPixels& pixels, PngDepth depth) {
  constexpr char grey = 0, red_green_blue = 2, no_filter = 0;
  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(pixels.width));
  append_big_endian(header, static_cast<std::uint32_t>(pixels.height));
  header += static_cast<char>(depth);
  header += pixels.channels == 1 ? grey : red_green_blue;
  header += std::string_view("\0\0\0", 3);
  const std::size_t in_row = static_cast<std::size_t>(pixels.width) * pixels.channels;
  std::string rows;
  rows.reserve((2 * in_row + 1) * pixels.height);
  for (std::size_t k = 0; k < pixels.values.size(); ++k) {
    if (k % in_row == 0) rows += no_filter;
    rows += static_cast<char>(pixels.values[k] >> 8);
    if (depth == PngDepth::sixteen) rows += static_cast<char>(pixels.values[k] & 0xff);
  }
  std::string bytes("\x89PNG\r\n\x1a\n", 8);
  append_png_chunk(bytes, "IHDR", header);
  append_png_chunk(bytes, "IDAT", compress(rows));
  append_png_chunk(bytes, "IEND", {});
  return bytes;
}

PngPixels parse_png(std::string_view bytes) {
  if (bytes.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw MeshError("the PNG has more than 2 GB");
  const auto* const data = reinterpret_cast<const stbi_uc*>(bytes.data());
  const int size = static_cast<int>(bytes.size());
  PngPixels pixels;
  int channels = 0;
  if (stbi_info_from_memory(data, size, &pixels.width, &pixels.height, &channels) == 0)
    throw MeshError(fmt::format("the file is no PNG ({})", stbi_failure_reason()));
  constexpr std::size_t best_ratio = 1032, bits_in_byte = 8;  // of deflate
  if (static_cast<std::size_t>(pixels.width) * pixels.height / (bits_in_byte * best_ratio) > bytes.size())
    throw MeshError(fmt::format("the PNG promises {} x {} pixels, for which it has too few bytes",
                                pixels.width, pixels.height));
  pixels.channels = channels < 3 ? 1 : 3;
  const std::unique_ptr<stbi_us, FreeStb> loaded(
      stbi_load_16_from_memory(data, size, &pixels.width, &pixels.height, &channels, pixels.channels));
  if (!loaded) throw MeshError(fmt::format("the PNG is damaged ({})", stbi_failure_reason()));
  const std::size_t count = static_cast<std::size_t>(pixels.width) * pixels.height * pixels.channels;
  pixels.values.assign(loaded.get(), loaded.get() + count);
  return pixels;
}

}  // namespace orbitutte
