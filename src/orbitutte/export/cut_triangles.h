// SPDX-License-Identifier: MIT
// The triangles of a polygonal mesh's embedding.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Does the cut mesh have face f of the input turned over, from the same corner on? Some faces of a
/// projective plane are. The embedding must be one of the surface.
bool is_turned_face(const Surface& surface, const Embedding& embedding, int f);

/// The corner of the cut mesh's face f that is the input's k-th.
int cut_corner(const Surface& surface, const Embedding& embedding, int f, int k);

/// The embedding's faces divided in the same way as the surface's, T x 3. The embedding must be one of the
/// surface.
Triangles cut_triangles(const Surface& surface, const Embedding& embedding);

}  // namespace orbitutte
