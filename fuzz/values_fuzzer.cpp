// SPDX-License-Identifier: MIT
// libFuzzer's entry point. ORBITUTTE_FUZZ_FORMAT is the VertexDataFormat of the target.
#include <cstddef>
#include <cstdint>

#include "round_trip.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  orbitutte::fuzz::check_value_round_trip(bytes, orbitutte::VertexDataFormat::ORBITUTTE_FUZZ_FORMAT);
  return 0;
}
