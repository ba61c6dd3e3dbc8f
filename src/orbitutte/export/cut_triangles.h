// SPDX-License-Identifier: MIT
// The triangles of a polygonal mesh's embedding.
#pragma once

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// Does the cut mesh have face f of the input the other way round, from the same corner on? So it has some of
/// a projective plane. The embedding is one of the surface.
bool is_turned(const Surface& surface, const Embedding& embedding, int f);

/// Which corner of the cut mesh's face f is the input's k-th.
int cut_corner(const Surface& surface, const Embedding& embedding, int f, int k);

/// The embedding's faces, divided as those of the surface were, T x 3. The embedding is one of the surface.
Faces cut_triangles(const Surface& surface, const Embedding& embedding);

}  // namespace orbitutte
