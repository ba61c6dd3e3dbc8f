// SPDX-License-Identifier: MIT
// Options of single stages of the method.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "orbitutte/names.h"
#include "orbitutte/types.h"

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

/// Which of all Möbius maps a map to the whole sphere, or to a hemisphere, is followed by.
enum class Centre {
  /// None: the map is as the quotient gives it.
  none,
  /// The centre of mass of the surface's area comes to lie at the centre of the sphere.
  area,
  /// The centre of mass of its vertices does, each counted alike.
  vertices,
  /// The scale of lengths varies least (Distortion::sigma).
  sigma
};

/// Its names.
template <>
struct NameTable<Centre> {
  static constexpr NamedValue<Centre> rows[] = {{Centre::none, "none"},
                                                {Centre::area, "area"},
                                                {Centre::vertices, "vertices"},
                                                {Centre::sigma, "sigma"}};
};

/// How a map to the whole sphere (1) or to a hemisphere (*) is made from a map to an orbifold: as its
/// quotient by the group.
struct QuotientOptions {
  /// Is the quotient of the map to a target with marks wanted in its place? Targets without marks have no
  /// other map.
  bool is_wanted = false;

  /// If not given, area for targets without marks, none for the quotients of others.
  std::optional<Centre> centre;

  /// Up to three vertices that come to lie at given points. Three leave no choice to `centre`, two that along
  /// the arc between them, one all.
  std::vector<PolygonCorner> points;
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
