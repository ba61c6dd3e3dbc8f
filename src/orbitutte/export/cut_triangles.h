// SPDX-License-Identifier: MIT
// The triangles of a polygonal mesh's embedding.
#pragma once

#include "orbitutte/mesh/triangulation.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Does the cut mesh have face f of the input turned over, from the same corner on? Some faces of a
/// projective plane are. The embedding must be one of the mesh.
bool is_turned(const PolygonMesh& mesh, const Embedding& embedding, int f);

/// The corner of the cut mesh's face f that is the input's k-th.
int cut_corner(const PolygonMesh& mesh, const Embedding& embedding, int f, int k);

/// The embedding's polygons divided in the same way as the mesh's, T x 3. The embedding must be one of the
/// mesh.
Faces cut_triangles(const PolygonMesh& mesh, const Triangulation& triangulation, const Embedding& embedding);

}  // namespace orbitutte
