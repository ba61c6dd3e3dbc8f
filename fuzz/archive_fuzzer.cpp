// SPDX-License-Identifier: MIT
// NumPy's archives: bytes are refused in one sentence, or what is read comes back after it was written.
#include <cstdint>
#include <cstdlib>
#include <string_view>

#include "orbitutte/errors.h"
#include "orbitutte/io/numpy_array.h"

namespace {

using orbitutte::NumpyArchive;

bool are_same(const NumpyArchive& a, const NumpyArchive& b) {
  if (a.size() != b.size()) return false;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const auto& [name, array] = a[k];
    if (name != b[k].first || array.shape != b[k].second.shape ||
        array.values.size() != b[k].second.values.size())
      return false;
  }
  return true;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view bytes(reinterpret_cast<const char*>(data), size);
  try {
    const NumpyArchive archive = orbitutte::parse_numpy_archive(bytes);
    if (!are_same(archive, orbitutte::parse_numpy_archive(orbitutte::serialize_numpy_archive(archive))))
      std::abort();
  } catch (const orbitutte::MeshError&) {
    return 0;
  }
  return 0;
}
