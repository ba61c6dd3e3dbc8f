// SPDX-License-Identifier: MIT
// Reads binary data whose numbers have their highest byte first.
#pragma once

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <string_view>

#include "orbitutte/errors.h"
#include "orbitutte/io/bytes.h"

namespace orbitutte {

/// Takes numbers and texts from the front of the bytes. Every complaint, a MeshError, names the byte and what
/// was to be read.
class BigEndianBytes {
 public:
  /// place: from where bytes are counted, " behind the first line"; empty from the beginning of the file.
  explicit BigEndianBytes(std::string_view bytes, std::string_view place = {})
      : bytes_(bytes), place_(place) {}

  template <class T>
  T take(std::string_view what) {
    return load<T>(take_bytes(sizeof(T), what).data(), std::endian::big);
  }

  /// A whole number of three bytes.
  int take_three_bytes(std::string_view what) {
    int value = 0;
    for (const char c : take_bytes(3, what)) value = value << 8 | static_cast<unsigned char>(c);
    return value;
  }

  /// A count of things, each of which has so many bytes at least, and all of which follow.
  int take_count(std::string_view what, std::size_t least_size) {
    const auto count = take<std::int32_t>(what);
    require_room(count, what, least_size);
    return count;
  }

  void require_room(std::int32_t count, std::string_view what, std::size_t least_size) const {
    if (count < 0 || static_cast<std::size_t>(count) > bytes_left() / least_size)
      refuse(fmt::format("{} is {}, but only {} bytes follow", what, count, bytes_left()));
  }

  /// A text whose length stands before it. Its last byte is zero.
  std::string take_text(std::string_view what) {
    const int length = take_count(fmt::format("the length of {}", what), 1);
    const std::string_view text = take_bytes(static_cast<std::size_t>(length), what);
    return std::string(text.substr(0, text.find('\0')));
  }

  std::size_t bytes_left() const { return bytes_.size() - at_; }

  [[noreturn]] void refuse(std::string_view problem) const {
    throw MeshError(fmt::format("byte {}{}: {}; copy or export the file again", at_, place_, problem));
  }

 private:
  std::string_view take_bytes(std::size_t size, std::string_view what) {
    if (size > bytes_left()) refuse(fmt::format("the file ends before {}", what));
    at_ += size;
    return bytes_.substr(at_ - size, size);
  }

  std::string_view bytes_, place_;
  std::size_t at_ = 0;
};

}  // namespace orbitutte
