// SPDX-License-Identifier: MIT
// Colours of vertices, from the numbers that stand in a file. No colour makes a reader refuse a mesh.
#pragma once

#include <string>

#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

/// The colours of a mesh, and what a user should know of them.
struct VertexColours {
  /// n x 3, 0 .. 1; or none.
  Points values = Points(0, 3);
  /// One sentence; empty if there is nothing to say.
  std::string warning;
};

/// Colours from bytes, n x 3, of which 255 is full. If one is not within 0 .. 255, there are none, and there
/// is a warning.
VertexColours colours_of_bytes(const Points& channels);

/// Colours from numbers of any kind, n x 3. They are numbers of 0 .. 1 or, if one is above 1, of 0 .. 255; a
/// number that exceeds 1 only by rounding counts as 1. Numbers of 0 .. 255 that are not all whole bring a
/// warning. If one is not within 0 .. 255 or not a number, there are no colours, and there is a warning.
VertexColours colours_of_numbers(const Points& channels);

/// No colours: `reason` begins with what is wrong.
VertexColours no_colours(const std::string& reason);

/// Gives the colours to the mesh, and their warning to its warnings.
void give_colours(VertexColours colours, PolygonMesh& mesh);

}  // namespace orbitutte
