// SPDX-License-Identifier: MIT
// The part of a large embedding that is drawn: some of its vertices, with fewer triangles between them.
#pragma once

#include <array>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Triangles on display vertices, and the tile's outline: the edges that lie in only one of them.
struct DisplayLevel {
  Triangles faces;
  std::vector<std::array<int, 2>> outline;
};

/// A mesh to be drawn, coarsened if it is large.
struct DisplayMesh {
  /// The cut vertex of every display vertex, ascending; both have exactly the same position.
  std::vector<int> cut_vertex;
  /// For the source and for the tile.
  DisplayLevel fine;
  /// For the copies of the tile, which are small.
  DisplayLevel coarse;
};

/// The largest numbers of triangles that are drawn.
struct DisplayLimits {
  /// Of the fine level.
  int faces = 400000;
  /// Of all |G| copies of the coarse level together.
  int tiling_faces = 600000;
};

/// A level is the whole cut mesh if that is within the limit. Otherwise edge collapses make it (quadric
/// error, meshoptimizer). The outline is never coarsened, so that copies still meet; for this reason a level
/// may exceed its limit. Vertices that no face uses are left out.
DisplayMesh display_mesh(const Surface& surface, const Embedding& embedding,
                         const DisplayLimits& limits = {});

}  // namespace orbitutte
