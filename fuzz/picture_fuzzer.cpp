// SPDX-License-Identifier: MIT
// PNG: bytes are refused in one sentence, or the pixels come back after they were written.
#include <cstddef>
#include <cstdint>

#include "picture_round_trip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  orbitutte::fuzz::check_picture_round_trip(bytes);
  orbitutte::fuzz::check_picture_round_trip(orbitutte::fuzz::with_right_checksums(std::string(bytes)));
  return 0;
}
