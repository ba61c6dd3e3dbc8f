// SPDX-License-Identifier: MIT
// Recognises a sound surface quickly; what is wrong with any other, `inspect` tells.
#pragma once

#include <optional>

#include "orbitutte/mesh/connectivity.h"

namespace orbitutte {

/// A surface on which `inspect` finds no defect.
struct SoundSurface {
  Topology topology = Topology::sphere;
  Connectivity connectivity;
  int unreferenced_vertices = 0;
  int zero_area_faces = 0;  ///< as Inspection counts them
};

/// The mesh as a sphere or disk, in a few linear sweeps; nothing where it is another surface, or has a defect
/// of any kind.
std::optional<SoundSurface> recognize(const Mesh& mesh);

/// Has the triangle no area but rounding errors, for the largest coordinate of its edges as the unit?
bool is_degenerate(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace orbitutte
