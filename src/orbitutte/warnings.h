// SPDX-License-Identifier: MIT
// What a user should know about an embedding, one sentence each.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/solve/ears.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// Warnings about weights that are zero, and about faces that a side of the tile flattens.
std::vector<std::string> warnings_about(const EdgeWeights& weights, const std::vector<Ear>& ears);

/// At most one warning: about a sphere that is inside out, so that its volume is negative.
std::vector<std::string> warnings_of_orientation(const Surface& surface);

/// The input vertices of each mirror and held side, along the boundary, as collapsing_faces needs them.
/// source_vertex: that of the cut mesh.
std::vector<std::vector<int>> mirrors_of(const Tile& tile, const BoundaryConditions& boundary,
                                         const std::vector<int>& source_vertex);

/// At most one warning: about those faces that are not positively oriented and that no solver could have
/// made positive, because they are among the collapsing faces or beside them.
std::vector<std::string> warnings_of_collapse(const FaceView& faces, const std::vector<int>& collapsing,
                                              const std::vector<int>& nonpositive);

/// About weights that were taken in place of the standard ones, which gave no bijection.
std::string warning_of_replaced_weights(const EmbedResult& standard, const EmbedResult& taken);

}  // namespace orbitutte
