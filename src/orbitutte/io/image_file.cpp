// SPDX-License-Identifier: MIT
#include "orbitutte/io/image_file.h"

#include <fmt/format.h>
#include <png.h>
#include <turbojpeg.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <type_traits>

#include "orbitutte/errors.h"
#include "orbitutte/io/file.h"

namespace orbitutte {
namespace {

constexpr long long longest_side = 32768;
constexpr int bytes_per_pixel = 4;

static_assert(sizeof(Pixel) == bytes_per_pixel, "rows of pixels are rows of bytes");

// No memory is taken for what no picture is.
PixelImage blank_image(long long width, long long height) {
  if (width < 1 || height < 1 || width > longest_side || height > longest_side)
    throw FileError(fmt::format("the picture has {} x {} pixels; sides of 1 to {} can be read", width, height,
                                longest_side));
  PixelImage image;
  image.width = static_cast<int>(width);
  image.height = static_cast<int>(height);
  image.pixels.resize(static_cast<std::size_t>(width * height));
  return image;
}

// libpng's simplified interface, which is freed whatever happens.
class PngStruct {
 public:
  PngStruct() {
    std::memset(&png_, 0, sizeof png_);
    png_.version = PNG_IMAGE_VERSION;
  }
  ~PngStruct() { png_image_free(&png_); }
  PngStruct(const PngStruct&) = delete;
  PngStruct& operator=(const PngStruct&) = delete;

  png_image& operator*() { return png_; }
  png_image* operator->() { return &png_; }
  png_image* get() { return &png_; }

 private:
  png_image png_;
};

PixelImage pixels_of_png(std::string_view bytes) {
  PngStruct png;
  if (png_image_begin_read_from_memory(png.get(), bytes.data(), bytes.size()) == 0)
    throw FileError(fmt::format("the PNG cannot be read: {}", png->message));
  PixelImage image = blank_image(png->width, png->height);
  png->format = PNG_FORMAT_RGBA;
  if (png_image_finish_read(png.get(), nullptr, image.pixels.data(), 0, nullptr) == 0)
    throw FileError(fmt::format("the PNG cannot be read: {}", png->message));
  return image;
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

std::string without_opacity(const PixelImage& image) {
  std::string bytes;
  bytes.reserve(3 * image.pixels.size());
  for (const Pixel& pixel : image.pixels) bytes.append(reinterpret_cast<const char*>(pixel.data()), 3);
  return bytes;
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
  const bool opaque = is_opaque(image);
  const std::string three = opaque ? without_opacity(image) : std::string();
  const void* const pixels = opaque ? static_cast<const void*>(three.data()) : image.pixels.data();
  PngStruct png;
  png->width = image.width;
  png->height = image.height;
  png->format = opaque ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(*png);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(png.get(), bytes.data(), &size, 0, pixels, 0, nullptr) == 0)
    throw Error(fmt::format("the PNG cannot be made: {}", png->message));
  bytes.resize(size);
  return bytes;
}

}  // namespace orbitutte
