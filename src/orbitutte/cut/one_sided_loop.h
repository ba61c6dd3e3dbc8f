// SPDX-License-Identifier: MIT
// Closed surfaces without an orientation: edge paths that reverse it, and faces that agree once such a path
// is opened.
#pragma once

#include <vector>

#include "orbitutte/cut/paths.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

/// Do any two faces run along a common edge in the same direction?
bool has_turned_faces(const Triangles& F, const std::vector<int>& opposite);

/// A simple closed edge path through a vertex of the projective plane that reverses orientation. Its first
/// and last vertex are the given one. It is the shortest such path if that is simple. Otherwise it joins the
/// vertex, by two disjoint paths of least total length, to the shortest one-sided loop inside that path.
/// Opening it leaves a disk. O(n log n).
Path one_sided_loop(const EdgeGraph& graph, const Surface& surface, int vertex);

/// The faces of a closed surface, some of them turned over so that all agree across every half-edge that is
/// not opened (opposite[h] >= 0). A face keeps its first vertex when it is turned over; face 0 is never
/// turned.
Triangles agreeing_faces(const Triangles& F, const std::vector<int>& opposite);

}  // namespace orbitutte
