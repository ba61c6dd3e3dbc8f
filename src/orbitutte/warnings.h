// SPDX-License-Identifier: MIT
// What a user should know about an embedding, one sentence each.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/embed_types.h"
#include "orbitutte/solve/ears.h"
#include "orbitutte/weights/weights.h"

namespace orbitutte {

/// About weights that are zero, and faces that a side flattens.
std::vector<std::string> warnings_about(const EdgeWeights& weights, const std::vector<Ear>& ears);

/// About a sphere that is inside out: its volume is negative. None, or one warning.
std::vector<std::string> warnings_of_orientation(const Surface& surface);

/// The input vertices of each mirror and held side, along the boundary: those that collapsing_faces asks for.
/// source_vertex: of the cut mesh.
std::vector<std::vector<int>> mirrors_of(const Tile& tile, const BoundaryConditions& boundary,
                                         const std::vector<int>& source_vertex);

/// About faces that are not positively oriented, those of them that no solver could have done better: they
/// are among the collapsing ones, or beside them. None, or one warning.
std::vector<std::string> warnings_of_collapse(const FaceView& faces, const std::vector<int>& collapsing,
                                              const std::vector<int>& nonpositive);

/// About weights that were taken in place of the standard ones, which gave no bijection.
std::string warning_of_replaced_weights(const EmbedResult& standard, const EmbedResult& taken);

}  // namespace orbitutte
