// SPDX-License-Identifier: MIT
// Vertices marked as cones and corners of given angles (cone_target.h).
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/surface.h"
#include "orbitutte/orbifold/cone_target.h"

namespace orbitutte {

/// A target of cones and corners, and the vertices that carry its marks.
struct MarkedCones {
  Target target;
  std::vector<int> vertices;
};

/// The target with these angles at these vertices: all cones for `cones`. For `*cones`, vertices inside are
/// cones, and those on the boundary corners; the cones come first, both in the given order. Vertices that the
/// surface does not have count as inside; embed refuses them. Throws ArgumentError if there is not one angle
/// for each vertex, and as cone_target does.
MarkedCones marked_cones(const Surface& surface, const std::string& signature,
                         const std::vector<int>& vertices, const std::vector<double>& angles);

/// The same at well separated extremities (choose_extremities), for `*cones` all on the boundary. Throws
/// MeshError if the surface has too few vertices there, or another topology than the signature needs.
MarkedCones cones_at_extremities(const Surface& surface, const std::string& signature,
                                 const std::vector<double>& angles);

}  // namespace orbitutte
