// SPDX-License-Identifier: MIT
// What of a large embedding is drawn: a selection of its vertices, and fewer triangles between them.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Triangles on display vertices, and the edges that lie in only one of them: the tile's outline.
struct DisplayLevel {
  Faces faces;
  std::vector<std::array<int, 2>> outline;
};

/// A mesh to be drawn, coarsened where it is large.
struct DisplayMesh {
  std::vector<int> cut_vertex;  ///< of every display vertex, ascending; the positions are exactly its own
  DisplayLevel fine;            ///< for the source and the tile
  DisplayLevel coarse;          ///< for the copies of the tile, which are small
};

/// How much is drawn.
struct DisplayLimits {
  int faces = 400000;         ///< of the fine level
  int tiling_faces = 600000;  ///< of |G| copies of the coarse level
};

/// A level is the whole cut mesh where that is within the limit, otherwise made by edge collapses (quadric
/// error, meshoptimizer). The outline is never coarsened, so that copies still meet; therefore a level may
/// exceed its limit. Vertices that no face uses are left out.
DisplayMesh display_mesh(const Surface& surface, const Embedding& embedding,
                         const DisplayLimits& limits = {});

}  // namespace orbitutte
