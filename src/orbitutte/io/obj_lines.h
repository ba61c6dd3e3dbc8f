// SPDX-License-Identifier: MIT
// The lines of OBJ files that several writers have in common.
#pragma once

#include <string>

#include "orbitutte/mesh/texture_layout.h"

namespace orbitutte {

/// Appends a line `v x y z` for each point (n x 3), with the shortest decimals that read back as the same
/// doubles.
void append_obj_vertices(const Points& points, std::string& text);

/// Appends the lines of a surface's positions, texture coordinates and faces. The layout has a row for every
/// corner of the surface's faces.
void append_textured_obj(const Surface& surface, const TextureLayout& layout, std::string& text);

}  // namespace orbitutte
