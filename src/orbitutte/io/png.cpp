// SPDX-License-Identifier: MIT
// PNG (ISO/IEC 15948), by libpng, from and to memory.
//
// A function of libpng that fails ends by longjmp, which must not skip a destructor. So all that can fail
// runs within try_png, and while it runs, nothing that has a destructor is made there or in a callback.
// Exceptions are thrown after try_png has returned.
#include "orbitutte/io/png.h"

#include <fmt/format.h>
#include <png.h>

#include <algorithm>
#include <bit>
#include <csetjmp>
#include <cstdio>
#include <cstring>
#include <exception>
#include <new>
#include <type_traits>

#include "orbitutte/errors.h"
#include "orbitutte/io/bytes.h"

namespace orbitutte {
namespace {

constexpr std::string_view png_signature("\x89PNG\r\n\x1a\n", 8);

/// What the numbers of a file mean: nothing but themselves, or colours in sRGB.
enum class PngMeaning { values, colours };

struct PngFailure {
  char reason[200] = "";
};

// libpng's callback for errors, which must not return.
[[noreturn]] void leave_png(png_structp png, png_const_charp message) {
  auto* const failure = static_cast<PngFailure*>(png_get_error_ptr(png));
  std::snprintf(failure->reason, sizeof failure->reason, "%s", message);
  png_longjmp(png, 1);
}

void ignore_png_warning(png_structp /*png*/, png_const_charp /*message*/) {}

/// Whether the steps came to their end; otherwise the reason is in the PngFailure of `png`.
template <typename Steps>
bool try_png(png_structp png, const Steps& steps) {
  static_assert(std::is_trivially_destructible_v<Steps>, "longjmp skips destructors");
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  steps();
  return true;
}

// 16 bits have their high byte first in files.
void set_order_of_bytes(png_structp png, PngDepth depth) {
  if (depth == PngDepth::sixteen && std::endian::native == std::endian::little) png_set_swap(png);
}

// Reading ---------------------------------------------------------------------------------------------------

// libpng's callback: the next bytes of what is left.
void take_png_bytes(png_structp png, png_bytep target, std::size_t size) {
  auto* const rest = static_cast<std::string_view*>(png_get_io_ptr(png));
  if (size > rest->size()) png_error(png, "the file ends too early");
  std::memcpy(target, rest->data(), size);
  rest->remove_prefix(size);
}

// Every checksum has to be right. Of what is not pixels, only transparent colours and, for colours, the gamma
// are looked at.
void set_png_policy(png_structp png, PngMeaning meaning) {
  constexpr int all_optional = -1;
  constexpr png_byte gamma[] = "gAMA\0sRGB";
  png_set_crc_action(png, PNG_CRC_DEFAULT, PNG_CRC_ERROR_QUIT);
  png_set_user_limits(png, longest_picture_side, longest_picture_side);
  png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_NEVER, nullptr, all_optional);
  if (meaning == PngMeaning::colours) png_set_keep_unknown_chunks(png, PNG_HANDLE_CHUNK_AS_DEFAULT, gamma, 2);
}

// From any kind of pixels to these.
void set_png_conversion(png_structp png, int channels, PngDepth depth, PngMeaning meaning) {
  constexpr png_uint_32 opaque = 0xffff;
  png_set_expand(png);
  if (depth == PngDepth::sixteen) {
    png_set_expand_16(png);
  } else {
    png_set_scale_16(png);
  }
  if (channels >= 3) png_set_gray_to_rgb(png);
  if (channels == 4) {
    png_set_add_alpha(png, opaque, PNG_FILLER_AFTER);
  } else {
    png_set_strip_alpha(png);
  }
  if (meaning == PngMeaning::colours) png_set_alpha_mode(png, PNG_ALPHA_PNG, PNG_DEFAULT_sRGB);
  set_order_of_bytes(png, depth);
}

// The rows of an interlaced picture come several times, each time with more of their pixels.
void read_png_rows(png_structp png, png_infop info, png_bytep pixels, std::size_t bytes_in_row) {
  const int passes = png_set_interlace_handling(png);
  png_read_update_info(png, info);
  if (png_get_rowbytes(png, info) != bytes_in_row) png_error(png, "its pixels have an unexpected size");
  const png_uint_32 height = png_get_image_height(png, info);
  for (int pass = 0; pass < passes; ++pass)
    for (png_uint_32 row = 0; row < height; ++row) png_read_row(png, pixels + row * bytes_in_row, nullptr);
  png_read_end(png, nullptr);
}

// Of sides that are too long libpng would not say how long they are. All else is left to it.
void check_png_start(std::string_view bytes) {
  constexpr std::size_t type_at = 12, width_at = 16, header_end = 24;
  if (!bytes.starts_with(png_signature)) throw MeshError("the file is no PNG");
  if (bytes.size() < header_end || !bytes.substr(type_at).starts_with("IHDR")) return;
  const auto width = load<std::uint32_t>(bytes.data() + width_at, std::endian::big),
             height = load<std::uint32_t>(bytes.data() + width_at + sizeof(std::uint32_t), std::endian::big);
  if (std::min(width, height) < 1 || std::max(width, height) > longest_picture_side)
    throw MeshError(fmt::format("the PNG has {} x {} pixels; sides of 1 to {} can be read", width, height,
                                longest_picture_side));
}

class PngReader {
 public:
  PngReader(std::string_view bytes, PngMeaning meaning)
      : size_(bytes.size()), rest_(bytes), meaning_(meaning) {
    check_png_start(bytes);
    png_ = png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure_, leave_png, ignore_png_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_read_struct(&png_, nullptr, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngReader() { png_destroy_read_struct(&png_, &info_, nullptr); }
  PngReader(const PngReader&) = delete;
  PngReader& operator=(const PngReader&) = delete;

  PngLayout read_layout() {
    run([this] {
      png_set_read_fn(png_, &rest_, take_png_bytes);
      set_png_policy(png_, meaning_);
      png_read_info(png_, info_);
    });
    PngLayout layout;
    layout.width = static_cast<int>(png_get_image_width(png_, info_));
    layout.height = static_cast<int>(png_get_image_height(png_, info_));
    layout.channels = (png_get_color_type(png_, info_) & PNG_COLOR_MASK_COLOR) == 0 ? 1 : 3;
    constexpr std::size_t best_ratio = 1032;  // of deflate
    if (png_get_rowbytes(png_, info_) * layout.height / best_ratio > size_)
      throw MeshError(fmt::format("the PNG promises {} x {} pixels, for which it has too few bytes",
                                  layout.width, layout.height));
    return layout;
  }

  /// After read_layout, into width x height x channels numbers.
  template <typename Number>
  void read_pixels(const PngLayout& layout, Number* pixels) {
    constexpr PngDepth depth = sizeof(Number) == 1 ? PngDepth::eight : PngDepth::sixteen;
    const std::size_t bytes_in_row =
        static_cast<std::size_t>(layout.width) * layout.channels * sizeof(Number);
    run([&] {
      set_png_conversion(png_, layout.channels, depth, meaning_);
      read_png_rows(png_, info_, reinterpret_cast<png_bytep>(pixels), bytes_in_row);
    });
  }

 private:
  template <typename Steps>
  void run(const Steps& steps) {
    if (!try_png(png_, steps)) throw MeshError(fmt::format("the PNG is damaged: {}", failure_.reason));
  }

  std::size_t size_;
  std::string_view rest_;
  PngMeaning meaning_;
  PngFailure failure_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

// Writing ---------------------------------------------------------------------------------------------------

bool has_appended(std::string& bytes, const png_byte* data, std::size_t size) noexcept {
  try {
    bytes.append(reinterpret_cast<const char*>(data), size);
    return true;
  } catch (const std::exception&) {
    return false;
  }
}

// libpng's callback, whose user data is the std::string.
void append_png_bytes(png_structp png, png_bytep data, std::size_t size) {
  if (!has_appended(*static_cast<std::string*>(png_get_io_ptr(png)), data, size))
    png_error(png, "there is too little memory");
}

void flush_no_png(png_structp /*png*/) {}

int png_colour_type(int channels) {
  if (channels == 1) return PNG_COLOR_TYPE_GRAY;
  return channels == 3 ? PNG_COLOR_TYPE_RGB : PNG_COLOR_TYPE_RGB_ALPHA;
}

class PngWriter {
 public:
  explicit PngWriter(PngMeaning meaning) : meaning_(meaning) {
    png_ = png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure_, leave_png, ignore_png_warning);
    info_ = png_ == nullptr ? nullptr : png_create_info_struct(png_);
    if (info_ == nullptr) {
      png_destroy_write_struct(&png_, nullptr);
      throw std::bad_alloc();
    }
  }
  ~PngWriter() { png_destroy_write_struct(&png_, &info_); }
  PngWriter(const PngWriter&) = delete;
  PngWriter& operator=(const PngWriter&) = delete;

  template <typename Number>
  std::string write(const PngLayout& layout, const Number* pixels) {
    const std::size_t in_row = static_cast<std::size_t>(layout.width) * layout.channels;
    std::string bytes;
    const bool is_written = try_png(png_, [&] {
      png_set_write_fn(png_, &bytes, append_png_bytes, flush_no_png);
      write_header(layout, sizeof(Number) == 1 ? PngDepth::eight : PngDepth::sixteen);
      for (int row = 0; row < layout.height; ++row)
        png_write_row(png_, reinterpret_cast<png_const_bytep>(pixels + row * in_row));
      png_write_end(png_, nullptr);
    });
    if (!is_written) throw Error(fmt::format("the PNG cannot be made: {}", failure_.reason));
    return bytes;
  }

 private:
  void write_header(const PngLayout& layout, PngDepth depth) {
    constexpr int compression_level = 6;
    png_set_user_limits(png_, PNG_UINT_31_MAX, PNG_UINT_31_MAX);
    png_set_compression_level(png_, compression_level);
    png_set_IHDR(png_, info_, static_cast<png_uint_32>(layout.width), static_cast<png_uint_32>(layout.height),
                 static_cast<int>(depth), png_colour_type(layout.channels), PNG_INTERLACE_NONE,
                 PNG_COMPRESSION_TYPE_BASE, PNG_FILTER_TYPE_BASE);
    if (meaning_ == PngMeaning::colours) png_set_sRGB(png_, info_, PNG_sRGB_INTENT_PERCEPTUAL);
    png_write_info(png_, info_);
    set_order_of_bytes(png_, depth);
  }

  PngMeaning meaning_;
  PngFailure failure_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

std::size_t numbers_in(const PngLayout& layout) {
  return static_cast<std::size_t>(layout.width) * layout.height * layout.channels;
}

void check_png_layout(const PngLayout& layout, std::size_t numbers) {
  if (layout.channels != 1 && layout.channels != 3 && layout.channels != 4)
    throw ArgumentError(fmt::format("a PNG has 1, 3 or 4 channels, not {}", layout.channels));
  if (layout.width < 1 || layout.height < 1 || numbers != numbers_in(layout))
    throw ArgumentError("a picture has as many pixels as its width times its height, and at least one");
}

std::vector<std::uint8_t> high_bytes(const std::vector<std::uint16_t>& values) {
  std::vector<std::uint8_t> bytes(values.size());
  std::transform(values.begin(), values.end(), bytes.begin(),
                 [](std::uint16_t value) { return static_cast<std::uint8_t>(value >> 8); });
  return bytes;
}

}  // namespace

std::string serialize_png(const PngPixels& pixels, PngDepth depth) {
  const PngLayout layout = {pixels.width, pixels.height, pixels.channels};
  if (layout.channels == 4) throw ArgumentError("values in a PNG have 1 or 3 channels, not 4");
  check_png_layout(layout, pixels.values.size());
  PngWriter writer(PngMeaning::values);
  return depth == PngDepth::sixteen ? writer.write(layout, pixels.values.data())
                                    : writer.write(layout, high_bytes(pixels.values).data());
}

PngPixels parse_png(std::string_view bytes) {
  PngReader reader(bytes, PngMeaning::values);
  const PngLayout layout = reader.read_layout();
  PngPixels pixels = {layout.width, layout.height, layout.channels,
                      std::vector<std::uint16_t>(numbers_in(layout))};
  reader.read_pixels(layout, pixels.values.data());
  return pixels;
}

PngLayout parse_png_layout(std::string_view bytes) {
  return PngReader(bytes, PngMeaning::values).read_layout();
}

void parse_png_colours(std::string_view bytes, std::span<std::uint8_t> colours) {
  PngReader reader(bytes, PngMeaning::colours);
  PngLayout layout = reader.read_layout();
  layout.channels = 4;
  check_png_layout(layout, colours.size());
  reader.read_pixels(layout, colours.data());
}

std::string serialize_png_colours(const PngLayout& layout, std::span<const std::uint8_t> colours) {
  check_png_layout(layout, colours.size());
  return PngWriter(PngMeaning::colours).write(layout, colours.data());
}

}  // namespace orbitutte
