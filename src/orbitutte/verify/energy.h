// SPDX-License-Identifier: MIT
// The energy of an embedding, computed again from its files.
#pragma once

#include "orbitutte/mesh/edge_weights.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// E = sum over undirected edges of the uncut mesh of w_ij d^2, d the arc length of one of the edge's images.
/// Equation (2). The embedding's faces must be those of the surface, cut (see certify). Of intrinsic weights
/// the edges are the geodesics of their triangulation, and d the arc length between images of their ends as
/// laid_out has them.
double dirichlet_energy(const Surface& surface, const EdgeWeights& weights, const Embedding& embedding);

}  // namespace orbitutte
