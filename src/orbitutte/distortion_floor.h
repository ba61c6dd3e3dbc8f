// SPDX-License-Identifier: MIT
// How close to conformal a map of a mesh can be at all.
#pragma once

#include <optional>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// What no weights get far below: the distortion of the mesh's triangles if its vertices lie where the map of
/// the surface subdivided twice, which is sixteen times as fine, has them. It is due to how coarse the mesh
/// is. The weights and the file of weights in `options` are not used; the finer map has the standard ones.
/// None if the finer map is not certified. Throws as embed does.
std::optional<Distortion> distortion_floor(const Surface& surface, const Target& target,
                                           const std::vector<int>& cones, const EmbedOptions& options = {});

}  // namespace orbitutte
