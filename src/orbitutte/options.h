// SPDX-License-Identifier: MIT
// Options of single stages of the method.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "orbitutte/names.h"

namespace orbitutte {

/// Chooses between the cuts through the same marked vertices.
struct CutOptions {
  /// Another seed gives another cut; 0 gives the shortest.
  std::uint64_t seed = 0;
};

/// How vertices are spread along an arc.
enum class Spread {
  /// In proportion to the lengths of the boundary's edges in the source.
  arc_length,
  equidistant
};

/// Its names.
template <>
struct NameTable<Spread> {
  static constexpr NamedValue<Spread> rows[] = {{Spread::arc_length, "arc-length"},
                                                {Spread::equidistant, "equidistant"}};
};

/// The libraries that factorise sparse matrices.
enum class Backend { cholmod, eigen };

/// Its names.
template <>
struct NameTable<Backend> {
  static constexpr NamedValue<Backend> rows[] = {{Backend::cholmod, "cholmod"}, {Backend::eigen, "eigen"}};
};

/// The backends in this binary; the first is the default (CMake option ORBITUTTE_SOLVER).
std::vector<Backend> available_backends();

/// The BLAS of this binary: OpenBLAS's own description if there is one, otherwise "unknown".
std::string blas_description();

/// How the linear systems are solved.
struct LaplacianOptions {
  Backend backend = available_backends().front();

  /// Parts of the mesh with at most so many vertices are factorised separately, at the same time as others.
  int block_size = 30000;
};

}  // namespace orbitutte
