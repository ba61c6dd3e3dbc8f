// SPDX-License-Identifier: MIT
// The ending of a path, by which writers choose a format. Private to export/.
#pragma once

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string>

namespace orbitutte {

/// ".ply" of "A Mesh.PLY".
inline std::string lower_case_ending(const std::filesystem::path& path) {
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(),
                 [](unsigned char c) { return std::tolower(c); });
  return ending;
}

}  // namespace orbitutte
