// SPDX-License-Identifier: MIT
// Numbers in binary files, of either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace orbitutte {

/// The number whose bytes begin at `bytes`, aligned or not.
template <class T>
T load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> value;
  std::copy_n(bytes, sizeof(T), value.begin());
  if (order != std::endian::native) std::reverse(value.begin(), value.end());
  return std::bit_cast<T>(value);
}

/// The bytes of the number, the lowest one first.
template <class T>
std::array<char, sizeof(T)> little_endian_bytes(T number) {
  auto value = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (std::endian::native != std::endian::little) std::reverse(value.begin(), value.end());
  return value;
}

/// Appends numbers one after the other without gaps, each with its lowest byte first.
template <class... T>
void append_little_endian(std::string& bytes, T... numbers) {
  std::array<char, (sizeof(T) + ...)>
      values;  // appended at once: every append asks anew whether there is room
  char* at = values.data();
  const auto store = [&](auto number) {
    const auto value = little_endian_bytes(number);
    at = std::copy(value.begin(), value.end(), at);
  };
  (store(numbers), ...);
  bytes.append(values.data(), values.size());
}

/// Appends a number, its highest byte first.
template <class T>
void append_big_endian(std::string& bytes, T number) {
  auto value = little_endian_bytes(number);
  std::reverse(value.begin(), value.end());
  bytes.append(value.data(), value.size());
}

}  // namespace orbitutte
