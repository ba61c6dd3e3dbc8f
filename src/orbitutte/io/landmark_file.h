// SPDX-License-Identifier: MIT
// Which vertices of two surfaces correspond, as files and as words of a command line.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "orbitutte/types.h"

namespace orbitutte {

/// A vertex of surface A, and the vertex of surface B that corresponds to it.
struct Landmark {
  int a = -1, b = -1;
};

/// Landmarks from a file with two columns, vertices of A and of B, separated by blanks or a comma. Empty
/// lines and what follows a `#` are ignored, and so is a first line that does not begin with a number.
/// Throws FileError, and MeshError naming the line.
std::vector<Landmark> read_landmarks(const std::string& path);

/// Landmarks from a list such as 12:7,300:512. Throws ArgumentError naming the entry.
std::vector<Landmark> parse_landmarks(std::string_view list);

/// Can the text be a list and no path: does it begin with a number and a colon?
bool is_landmark_list(std::string_view text);

}  // namespace orbitutte
