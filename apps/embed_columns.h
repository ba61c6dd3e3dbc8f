// SPDX-License-Identifier: MIT
// The options of `embed`, as those commands know them that embed many meshes.
#pragma once

#include <string>
#include <vector>

#include "commands.h"
#include "orbitutte/io/manifest.h"

namespace orbitutte::cli {

/// The options that each row of a manifest may give: all but those on threads, files that are written and
/// what is printed.
std::vector<ManifestColumn> embed_columns();

/// What `embed` is asked for by a mesh and options such as "--orbifold=432". Throws ArgumentError.
EmbedArguments parse_embed(const std::string& mesh, const std::vector<std::string>& options);

}  // namespace orbitutte::cli
