// SPDX-License-Identifier: MIT
// T0: what one sparse Cholesky factorisation of the mesh's Laplacian costs.
#pragma once

#include "orbitutte/types.h"

namespace orbitutte::benchmarks {

struct Factorisation {
  double analyze_seconds = 0;
  double factorize_seconds = 0;
  double total_seconds() const { return analyze_seconds + factorize_seconds; }
};

struct Yardstick {
  /// T0.
  Factorisation metis;
  /// The same with an elimination order by approximate minimum degree.
  Factorisation amd;
};

/// Times CHOLMOD (supernodal, defaults otherwise) on the scalar cotangent Laplacian of the uncut mesh. A
/// small multiple of the identity makes the matrix definite. It is assembled before the clock starts.
Yardstick measure_yardstick(const Mesh& mesh);

}  // namespace orbitutte::benchmarks
