// SPDX-License-Identifier: MIT
// The checksum of PNG's chunks, as the standard defines it (ISO/IEC 15948, annex D).
#pragma once

#include <cstdint>
#include <string_view>

namespace orbitutte::test {

/// Of type and content of a chunk.
inline std::uint32_t png_checksum(std::string_view bytes) {
  std::uint32_t remainder = 0xffffffff;
  for (const char byte : bytes) {
    remainder ^= static_cast<unsigned char>(byte);
    for (int bit = 0; bit < 8; ++bit) remainder = remainder >> 1 ^ (remainder % 2 == 1 ? 0xedb88320 : 0);
  }
  return ~remainder;
}

}  // namespace orbitutte::test
