// SPDX-License-Identifier: MIT
// How single stages of the method are done: options that programs set, and names of what there is to choose.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace orbitutte {

/// Which of all cuts through the same marked vertices.
struct CutOptions {
  std::uint64_t seed = 0;  ///< another seed takes another cut through the same marks; 0 takes the shortest
};

/// How vertices are spread along an arc.
enum class Spread {
  arc_length,  ///< in proportion to the lengths of the boundary's edges in the source
  equidistant
};

/// The libraries that factorise sparse matrices.
enum class Backend { cholmod, eigen };

/// "cholmod" or "eigen".
std::string name(Backend backend);

/// The backends in this binary; the first is the default (CMake option ORBITUTTE_SOLVER).
std::vector<Backend> available_backends();

/// The BLAS of this binary: OpenBLAS's own description where it can be asked, else "unknown".
std::string blas_description();

/// How the linear systems are solved.
struct LaplacianOptions {
  Backend backend = available_backends().front();

  /// Parts of the mesh with at most so many vertices are factorised each on its own, at the same time as
  /// others.
  int block_size = 30000;
};

}  // namespace orbitutte
