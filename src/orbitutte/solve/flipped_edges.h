// SPDX-License-Identifier: MIT
// The gluing of a triangulation that edge flips have made of the mesh.
#pragma once

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/solve/dirichlet_energy.h"

namespace orbitutte {

/// As glued_edges, of a triangulation of the uncut surface. Each face lies in a frame, and
/// its corners are images of vertices there, transforms of the group; at first every frame is that of the cut
/// mesh. A flip takes one of its two faces into the other's frame. So an edge has the group element of the
/// geodesic that it is, wherever that crosses the cut.
GluedEdges flipped_edges(const Surface& surface, const IntrinsicTriangulation& triangulation,
                         const CutMesh& cut, const BoundaryConditions& boundary);

}  // namespace orbitutte
