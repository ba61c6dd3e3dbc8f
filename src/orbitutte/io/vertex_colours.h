// SPDX-License-Identifier: MIT
// Colours of vertices, from the numbers that stand in a file. No colour makes a reader refuse a mesh.
#pragma once

#include <string>

#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

/// The colours of a mesh, and what a user should know of them.
struct VertexColours {
  Points values = Points(0, 3);  ///< n x 3, 0 .. 1; or none
  std::string warning;           ///< one sentence; empty if there is nothing to say
};

/// Colours from bytes, n x 3, of which 255 is full: none, with a warning, if one is not within 0 .. 255.
VertexColours colours_of_bytes(const Points& channels);

/// Colours from numbers of any kind, n x 3. They are of 0 .. 1, or, if one is above 1, of 0 .. 255. What
/// exceeds 1 by no more than rounding is 1. A warning says so unless the numbers are within 0 .. 1 or all
/// whole. None, with a warning, if one is not within 0 .. 255 or no number.
VertexColours colours_of_numbers(const Points& channels);

/// No colours: `reason` begins with what is wrong.
VertexColours no_colours(const std::string& reason);

/// Makes them the colours of the mesh, their warning one of its warnings.
void give_colours(VertexColours colours, PolygonMesh& mesh);

}  // namespace orbitutte
