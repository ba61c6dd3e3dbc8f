// SPDX-License-Identifier: MIT
// The triangles of a polygonal mesh's embedding.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Throws MeshError if the embedding is not one of the surface: unless each of its faces has the corners of
/// the input's face.
void require_cut_from(const Surface& surface, const Embedding& embedding);

/// Is face f of the input turned over in the cut mesh, beginning with the same corner? Some faces of a
/// projective plane are. The embedding must be one of the surface.
bool is_turned_face(const Surface& surface, const Embedding& embedding, int f);

/// The corner of face f of the cut mesh that is the k-th corner in the input.
int cut_corner(const Surface& surface, const Embedding& embedding, int f, int k);

/// The embedding's faces divided in the same way as the surface's, T x 3. The embedding must be one of the
/// surface.
Triangles cut_triangles(const Surface& surface, const Embedding& embedding);

}  // namespace orbitutte
