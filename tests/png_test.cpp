// SPDX-License-Identifier: MIT
#include "orbitutte/io/png.h"

#include <gmock/gmock.h>

#include <cmath>
#include <numeric>

#include "orbitutte/errors.h"
#include "orbitutte/io/bytes.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/image_file.h"
#include "png_checksum.h"

namespace orbitutte::png_test {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::ThrowsMessage;

/// A PNG put together by hand. The names of the kinds are those of the standard.
struct HandMade {
  enum Kind { grey = 0, rgb = 2, palette = 3, grey_with_opacity = 4, rgba = 6 };
  int width = 1, height = 1, depth = 8;
  Kind kind = grey;
  std::string rows = {};           // each after its filter
  std::string before_pixels = {};  // further chunks
  bool is_interlaced = false;
};

std::string chunk(const std::string& type, const std::string& content) {
  std::string bytes;
  append_big_endian(bytes, static_cast<std::uint32_t>(content.size()));
  bytes += type + content;
  append_big_endian(bytes, test::png_checksum(type + content));
  return bytes;
}

std::string bytes_of(const HandMade& png) {
  std::string header;
  append_big_endian(header, static_cast<std::uint32_t>(png.width));
  append_big_endian(header, static_cast<std::uint32_t>(png.height));
  header +=
      {static_cast<char>(png.depth), static_cast<char>(png.kind), 0, 0, png.is_interlaced ? '\1' : '\0'};
  return "\x89PNG\r\n\x1a\n" + chunk("IHDR", header) + png.before_pixels + chunk("IDAT", compress(png.rows)) +
         chunk("IEND", "");
}

std::string file_at(const std::string& path) {
  return read_file(std::string(ORBITUTTE_SOURCE_DIR) + "/" + path);
}

PngPixels ramp(int channels, PngDepth depth) {
  PngPixels pixels = {7, 5, channels, std::vector<std::uint16_t>(35 * channels)};
  for (int k = 0; k < 35 * channels; ++k)
    pixels.values[k] = static_cast<std::uint16_t>(depth == PngDepth::eight ? 257 * (2 * k) : 600 * k + 1);
  return pixels;
}

// Two rows, the first as differences to the left, the second as Paeth has them.
TEST(Png, FiltersAreUndone) {
  const PngPixels pixels = parse_png(file_at("tests/pictures/colour.png"));
  EXPECT_EQ(pixels.channels, 3);
  const std::vector<int> expected = {1, 2, 3, 2, 4, 6, 4, 6, 8, 7, 10, 13};
  ASSERT_EQ(pixels.values.size(), expected.size());
  for (std::size_t k = 0; k < expected.size(); ++k) EXPECT_EQ(pixels.values[k], 257 * expected[k]) << k;
}

TEST(Png, PixelsReadBack) {
  for (const int channels : {1, 3})
    for (const PngDepth depth : {PngDepth::eight, PngDepth::sixteen}) {
      const PngPixels pixels = ramp(channels, depth);
      const std::string bytes = serialize_png(pixels, depth);
      const PngPixels again = parse_png(bytes);
      EXPECT_EQ(again.width, 7);
      EXPECT_EQ(again.height, 5);
      EXPECT_EQ(again.channels, channels);
      EXPECT_EQ(again.values, pixels.values);
      EXPECT_EQ(serialize_png(again, depth), bytes) << "the same pixels give the same bytes";
    }
}

// The checksums tell.
TEST(Png, ThatIsDamagedAnywhereIsRefused) {
  const std::string gamma = chunk("gAMA", std::string("\0\1\x86\xa0", 4));
  for (const std::string& bytes :
       {serialize_png(ramp(3, PngDepth::sixteen), PngDepth::sixteen),
        bytes_of({.width = 2, .rows = std::string("\0ab", 3), .before_pixels = gamma})}) {
    ASSERT_NO_THROW(parse_png(bytes));
    for (std::size_t k = 0; k < bytes.size(); ++k) {
      std::string changed = bytes;
      changed[k] = static_cast<char>(changed[k] ^ 0x55);
      EXPECT_THROW(parse_png(changed), MeshError) << k;
      EXPECT_THROW(parse_png(bytes.substr(0, k)), MeshError) << k;
      EXPECT_THROW(parse_image(changed), FileError) << k;
      EXPECT_THROW(parse_image(bytes.substr(0, k)), FileError) << k;
    }
  }
  EXPECT_THAT([] { parse_png("no picture"); }, ThrowsMessage<MeshError>(HasSubstr("no PNG")));
}

TEST(Png, FewBitsAreScaled) {
  for (const int depth : {1, 2, 4}) {
    const int most = (1 << depth) - 1, in_byte = 8 / depth;
    std::string rows("\0", 1);
    int byte = 0;
    for (int k = 0; k < in_byte; ++k) byte = byte << depth | (k & most);
    rows += static_cast<char>(byte);
    const PngPixels pixels = parse_png(bytes_of({.width = in_byte, .depth = depth, .rows = rows}));
    ASSERT_EQ(pixels.values.size(), static_cast<std::size_t>(in_byte));
    for (int k = 0; k < in_byte; ++k) EXPECT_EQ(pixels.values[k], 65535 / most * (k & most)) << depth;
  }
}

TEST(Png, SixteenBitsHaveTheirHighByteFirst) {
  const std::string bytes = bytes_of({.depth = 16, .rows = std::string("\0\x12\x34", 3)});
  EXPECT_EQ(parse_png(bytes).values, (std::vector<std::uint16_t>{0x1234}));
}

TEST(Png, SixteenBitsAreRoundedToEight) {
  std::string rows("\0", 1);
  for (int value = 0; value < 65536; value += 13) append_big_endian(rows, static_cast<std::uint16_t>(value));
  const int width = static_cast<int>(rows.size() / 2);
  const PixelImage image = parse_image(bytes_of({.width = width, .depth = 16, .rows = rows}));
  for (int k = 0; k < width; ++k) {
    const auto nearest = static_cast<std::uint8_t>(std::lround(13 * k / 257.0));
    EXPECT_EQ(image.pixels[k], (Pixel{nearest, nearest, nearest, 255})) << k;
  }
}

// Adam7: seven passes, each with its first column and row and their steps.
TEST(Png, InterlacedPixelsFindTheirPlaces) {
  constexpr int size = 11, passes[7][4] = {{0, 0, 8, 8}, {4, 0, 8, 8}, {0, 4, 4, 8}, {2, 0, 4, 4},
                                           {0, 2, 2, 4}, {1, 0, 2, 2}, {0, 1, 1, 2}};
  std::string rows;
  for (const auto& [column, row, column_step, row_step] : passes)
    for (int y = row; y < size; y += row_step) {
      rows += '\0';
      for (int x = column; x < size; x += column_step) rows += static_cast<char>(size * y + x);
    }
  const PngPixels pixels =
      parse_png(bytes_of({.width = size, .height = size, .rows = rows, .is_interlaced = true}));
  for (int k = 0; k < size * size; ++k) EXPECT_EQ(pixels.values[k], 257 * k);
}

TEST(Png, PalettesGreysAndOpacityBecomeFourChannels) {
  const std::string colours("\x0a\x14\x1e\x28\x32\x3c", 6), opacities("\x80", 1);
  const std::string palette = bytes_of({.width = 2,
                                        .kind = HandMade::palette,
                                        .rows = std::string("\0\0\1", 3),
                                        .before_pixels = chunk("PLTE", colours) + chunk("tRNS", opacities)});
  EXPECT_EQ(parse_image(palette).pixels, (std::vector<Pixel>{{10, 20, 30, 128}, {40, 50, 60, 255}}));
  EXPECT_EQ(parse_png(palette).channels, 3);
  EXPECT_EQ(parse_png(palette).values[5], 257 * 60);

  const std::string grey =
      bytes_of({.kind = HandMade::grey_with_opacity, .rows = std::string("\0\x46\x0a", 3)});
  EXPECT_EQ(parse_image(grey).pixels, (std::vector<Pixel>{{70, 70, 70, 10}}));
  EXPECT_EQ(parse_png(grey).values, (std::vector<std::uint16_t>{257 * 70}));

  // One colour is the transparent one.
  const std::string keyed = bytes_of({.width = 2,
                                      .kind = HandMade::rgb,
                                      .rows = std::string("\0\1\2\3\1\2\4", 7),
                                      .before_pixels = chunk("tRNS", std::string("\0\1\0\2\0\3", 6))});
  EXPECT_EQ(parse_image(keyed).pixels, (std::vector<Pixel>{{1, 2, 3, 0}, {1, 2, 4, 255}}));

  const std::string all = bytes_of({.kind = HandMade::rgba, .rows = std::string("\0\1\2\3\4", 5)});
  EXPECT_EQ(parse_image(all).pixels, (std::vector<Pixel>{{1, 2, 3, 4}}));
  EXPECT_EQ(parse_png(all).values, (std::vector<std::uint16_t>{257, 514, 771}));
}

// sRGB's curve: 12.92 x for small x, otherwise 1.055 x^(1 / 2.4) - 0.055; libpng has x^(1 / 2.2).
TEST(Png, GammaChangesColoursAndNoValues) {
  std::string rows("\0", 1);
  for (int value = 0; value < 256; ++value) rows += static_cast<char>(value);
  const std::string linear = chunk("gAMA", std::string("\0\1\x86\xa0", 4)),
                    usual = chunk("gAMA", std::string("\0\0\xb1\x8f", 4));
  for (const std::string& gamma : {linear, usual}) {
    const std::string bytes = bytes_of({.width = 256, .rows = rows, .before_pixels = gamma});
    const PngPixels values = parse_png(bytes);
    const PixelImage colours = parse_image(bytes);
    for (int k = 0; k < 256; ++k) {
      EXPECT_EQ(values.values[k], 257 * k);
      EXPECT_NEAR(colours.pixels[k][0], gamma == usual ? k : 255 * std::pow(k / 255.0, 1 / 2.2), 1);
    }
  }
}

TEST(Png, LongSidesAreRefusedBeforeMemoryIsTaken) {
  const std::string rows("\0", 1);
  const auto reading = [&](int width, int height) {
    return [=] { parse_png(bytes_of({.width = width, .height = height, .rows = rows})); };
  };
  EXPECT_THAT(reading(longest_picture_side + 1, 1), ThrowsMessage<MeshError>(HasSubstr("32769 x 1 pixels")));
  EXPECT_THAT(reading(1, 0x7fffffff), ThrowsMessage<MeshError>(HasSubstr("1 x 2147483647 pixels")));
  EXPECT_THAT(reading(0, 3), ThrowsMessage<MeshError>(HasSubstr("0 x 3 pixels")));
  EXPECT_THAT(reading(longest_picture_side, longest_picture_side),
              ThrowsMessage<MeshError>(HasSubstr("too few bytes")));
}

TEST(Png, IsWrittenOfAllPixelsOnly) {
  PngPixels pixels = ramp(3, PngDepth::eight);
  pixels.values.pop_back();
  EXPECT_THROW(serialize_png(pixels, PngDepth::eight), ArgumentError);
  EXPECT_THROW(serialize_png({}, PngDepth::eight), ArgumentError);
  EXPECT_THROW(serialize_png({1, 1, 2, {0, 0}}, PngDepth::eight), ArgumentError);
  std::vector<std::uint8_t> colours(3);
  EXPECT_THROW(parse_png_colours(bytes_of({.rows = std::string(2, '\0')}), colours), ArgumentError);
}

}  // namespace
}  // namespace orbitutte::png_test
