// SPDX-License-Identifier: MIT
// Numbers in binary files, of either byte order.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <string>

namespace orbitutte {

/// The number whose bytes begin at `bytes`, which need not be aligned.
template <class T>
T load(const char* bytes, std::endian order) {
  std::array<char, sizeof(T)> value;
  std::copy_n(bytes, sizeof(T), value.begin());
  if (order != std::endian::native) std::reverse(value.begin(), value.end());
  return std::bit_cast<T>(value);
}

/// Appends a number, the lowest byte first.
template <class T>
void append_little_endian(std::string& bytes, T number) {
  auto value = std::bit_cast<std::array<char, sizeof(T)>>(number);
  if (std::endian::native != std::endian::little) std::reverse(value.begin(), value.end());
  bytes.append(value.data(), value.size());
}

}  // namespace orbitutte
