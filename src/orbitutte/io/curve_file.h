// SPDX-License-Identifier: MIT
// Text files of curves along the edges of a mesh.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace orbitutte {

/// A curve a line: two vertices or more, counted from 0, separated by blanks or commas. Empty lines and what
/// follows a `#` are ignored. Throws MeshError naming the line.
std::vector<std::vector<int>> parse_curves(std::string_view text);

/// The same of a file. Messages begin with the path. Throws FileError, too.
std::vector<std::vector<int>> read_curves(const std::string& path);

}  // namespace orbitutte
