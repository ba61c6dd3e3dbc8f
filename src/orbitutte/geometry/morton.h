// SPDX-License-Identifier: MIT
// A curve that fills space and keeps neighbours near to each other (G. M. Morton, 1966).
#pragma once

#include <cstdint>

namespace orbitutte {

/// The bits of a number below 2^21, each followed by two zeros.
constexpr std::uint64_t bits_with_gaps(std::uint64_t x) {
  x = (x | x << 32) & 0x1f00000000ffffULL;
  x = (x | x << 16) & 0x1f0000ff0000ffULL;
  x = (x | x << 8) & 0x100f00f00f00f00fULL;
  x = (x | x << 4) & 0x10c30c30c30c30c3ULL;
  return (x | x << 2) & 0x1249249249249249ULL;
}

/// The place on the curve of a cell of a grid, each coordinate below 2^21: their bits in turn, the lowest
/// first x, y, z.
constexpr std::uint64_t place_on_curve(std::uint64_t x, std::uint64_t y, std::uint64_t z) {
  return bits_with_gaps(x) | bits_with_gaps(y) << 1 | bits_with_gaps(z) << 2;
}

}  // namespace orbitutte
