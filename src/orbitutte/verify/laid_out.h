// SPDX-License-Identifier: MIT
// An embedding's images of other triangles than its own, each laid out in one piece.
#pragma once

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// The faces of the triangulation, each on three positions of its own: half-edge h begins at position h, an
/// image of vertex source_vertex[h] of the surface, so that the face lies in one piece. The flips are
/// repeated on the faces of the embedding: one of two faces is taken into the frame of the other by the
/// transform of the seam between them. Neither orientation nor positions of the result are judged here.
/// `embedding` is of the surface, and its seams fit (see certify). Where it has offsets, so has the result;
/// throws ArgumentError if a transform is no element of the target's group in its canonical frame then.
Embedding laid_out(const Surface& surface, const Embedding& embedding,
                   const IntrinsicTriangulation& triangulation);

/// The triangles of a coarse mesh as the embedding of the mesh subdivided has their vertices (subdivided,
/// mesh/subdivision.h, any number of times), each on three positions of its own, as above.
/// coarse: T x 3. `embedding` is of the fine surface, which is subdivided from it.
Embedding sampled_on(const Triangles& coarse, const Surface& fine, const Embedding& embedding);

}  // namespace orbitutte
