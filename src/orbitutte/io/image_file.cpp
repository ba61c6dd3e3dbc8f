// SPDX-License-Identifier: MIT
#include "orbitutte/io/image_file.h"

#include <fmt/format.h>
#include <turbojpeg.h>

#include <algorithm>
#include <memory>
#include <type_traits>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/png.h"

namespace orbitutte {
namespace {

constexpr int bytes_per_pixel = 4;

static_assert(sizeof(Pixel) == bytes_per_pixel, "rows of pixels are rows of bytes");

// No memory is taken for what no picture is.
PixelImage blank_image(long long width, long long height) {
  if (width < 1 || height < 1 || width > longest_picture_side || height > longest_picture_side)
    throw FileError(fmt::format("the picture has {} x {} pixels; sides of 1 to {} can be read", width, height,
                                longest_picture_side));
  PixelImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.pixels.resize(static_cast<std::size_t>(width * height));
  return image;
}

PixelImage pixels_of_png(std::string_view bytes) {
  try {
    const PngLayout layout = parse_png_layout(bytes);
    PixelImage image = blank_image(layout.width, layout.height);
    parse_png_colours(bytes, {image.pixels.front().data(), bytes_per_pixel * image.pixels.size()});
    return image;
  } catch (const MeshError& error) {
    throw FileError(error.what());
  }
}

PixelImage pixels_of_jpeg(std::string_view bytes) {
  const std::unique_ptr<std::remove_pointer_t<tjhandle>, int (*)(tjhandle)> jpeg(tjInitDecompress(),
                                                                                 tjDestroy);
  const auto fail = [&] {
    throw FileError(fmt::format("the JPEG cannot be read: {}", tjGetErrorStr2(jpeg.get())));
  };
  const auto* const data = reinterpret_cast<const unsigned char*>(bytes.data());
  int width = 0, height = 0, subsampling = 0, colours = 0;
  if (tjDecompressHeader3(jpeg.get(), data, bytes.size(), &width, &height, &subsampling, &colours) != 0)
    fail();
  PixelImage image = blank_image(width, height);
  if (tjDecompress2(jpeg.get(), data, bytes.size(), image.pixels.front().data(), width, 0, height, TJPF_RGBA,
                    TJFLAG_ACCURATEDCT) != 0)
    fail();
  return image;
}

bool is_opaque(const PixelImage& image) {
  return std::all_of(image.pixels.begin(), image.pixels.end(),
                     [](const Pixel& pixel) { return pixel[3] == 255; });
}

std::vector<std::uint8_t> without_opacity(const PixelImage& image) {
  std::vector<std::uint8_t> colours;
  colours.reserve(3 * image.pixels.size());
  for (const Pixel& pixel : image.pixels) colours.insert(colours.end(), pixel.begin(), pixel.begin() + 3);
  return colours;
}

}  // namespace

PixelImage parse_image(std::string_view bytes) {
  if (bytes.starts_with("\x89PNG\r\n\x1a\n")) return pixels_of_png(bytes);
  if (bytes.starts_with("\xff\xd8\xff")) return pixels_of_jpeg(bytes);
  throw FileError("the file is neither a PNG nor a JPEG; save the picture as one of these");
}

PixelImage read_image(const std::string& path) {
  const std::string bytes = read_file(path);
  try {
    return parse_image(bytes);
  } catch (const FileError& error) {
    throw FileError(fmt::format("{}: {}", path, error.what()));
  }
}

std::string png_bytes(const PixelImage& image) {
  if (image.width < 1 || image.height < 1 ||
      image.pixels.size() != static_cast<std::size_t>(image.width) * image.height)
    throw ArgumentError("a picture has as many pixels as its width times its height, and at least one");
  if (is_opaque(image)) return serialize_png_colours({image.width, image.height, 3}, without_opacity(image));
  return serialize_png_colours({image.width, image.height, bytes_per_pixel},
                               {image.pixels.front().data(), bytes_per_pixel * image.pixels.size()});
}

}  // namespace orbitutte
