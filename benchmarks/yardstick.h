// SPDX-License-Identifier: MIT
// T0: what one sparse Cholesky factorisation of the mesh's Laplacian costs.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte::benchmarks {

struct Yardstick {
  double analyze_seconds = 0;
  double factorize_seconds = 0;
  double total_seconds() const { return analyze_seconds + factorize_seconds; }
};

/// CHOLMOD (METIS order, supernodal, everything else as it comes) on the scalar cotangent Laplacian of the
/// uncut mesh, which is made definite by a small multiple of the identity. The matrix is assembled before the
/// clock starts.
Yardstick measure_yardstick(const Mesh& mesh);

}  // namespace orbitutte::benchmarks
