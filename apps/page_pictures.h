// SPDX-License-Identifier: MIT
// What other commands than 'render' need of pictures: those that stand in for the interactive view of a page,
// and where their viewer is.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "orbitutte/page/page.h"
#include "orbitutte/report/report.h"

namespace orbitutte::cli {

/// Empty in builds without pictures.
std::vector<PagePicture> page_pictures(const Surface& surface, const Embedding& embedding,
                                       const Report& report);

/// Writes a picture of the scale of a map, with its cones and the vertices among which these were chosen.
/// Throws ArgumentError in builds without pictures, and FileError.
void write_scale_picture(const std::string& path, const Surface& surface, const Embedding& embedding,
                         const std::vector<int>& candidates);

/// From where a picture shows the mesh: what is not given, the picture chooses.
struct Viewpoint {
  std::optional<Vector3> view, up;
};

/// As --view and --up say; empty if they are not given. Throws ArgumentError, and in builds without pictures
/// for all that is given.
Viewpoint parse_viewpoint(const std::string& view, const std::string& up, const Surface& surface);

}  // namespace orbitutte::cli
