// SPDX-License-Identifier: MIT
// Text files of what lies on a surface: numbers or labels of its vertices, curves along its edges.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

// Columns are separated by blanks or commas. Empty lines and what follows a `#` are ignored, and so is a
// first line that does not begin with a number. All throw MeshError naming the line.

/// Numbers, a line for every vertex, with as many columns as the first (n x c).
Eigen::MatrixXd parse_values(std::string_view text);

/// Whole numbers, one a line.
std::vector<int> parse_labels(std::string_view text);

/// A curve a line: two vertices or more, counted from 0.
std::vector<std::vector<int>> parse_curves(std::string_view text);

// The same of files. Messages begin with the path. Throw FileError, too.

Eigen::MatrixXd read_values(const std::string& path);
std::vector<int> read_labels(const std::string& path);
std::vector<std::vector<int>> read_curves(const std::string& path);

}  // namespace orbitutte
