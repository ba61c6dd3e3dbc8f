// SPDX-License-Identifier: MIT
// Texture coordinates in mesh files: those of an OBJ, which readers of meshes leave out.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "orbitutte/mesh/texture_layout.h"

namespace orbitutte {

/// The lines `vt` of an OBJ file's text, and which of them each corner has (`f 1/2 ...`). Nothing if no
/// corner has one. Throws MeshError naming the line if an index or a number makes no sense, or if some
/// corners have one and others do not.
std::optional<TextureLayout> parse_obj_texture(std::string_view text);

/// The same of a file, whose name ends in .obj or .obj.gz; nothing for other formats. Messages begin with the
/// path. Throws FileError and MeshError.
std::optional<TextureLayout> read_texture_layout(const std::string& path);

}  // namespace orbitutte
