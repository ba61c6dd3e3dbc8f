// SPDX-License-Identifier: MIT
// The surface that a mesh is, where it can be embedded.
#pragma once

#include <optional>

#include "orbitutte/mesh/triangulation.h"

namespace orbitutte {

// The sizes of meshes whose squared lengths are doubles.
inline constexpr double largest_coordinate = 1e150;
inline constexpr double smallest_size = 1e-150;

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

/// The mesh as a sphere, disk or projective plane. Throws MeshError with the first defect that `inspect`
/// finds.
SoundSurface require_surface(const Mesh& mesh);

/// A mesh of polygons as one of triangles, and how these make up the polygons.
struct DividedMesh {
  Mesh triangles;
  Triangulation triangulation;
  SoundSurface surface;
};

/// The polygons in triangles, on the same vertices. Throws as require_surface does.
DividedMesh divide(const PolygonMesh& mesh);

/// Has the triangle no area but rounding errors, for the largest coordinate of its edges as the unit?
bool is_degenerate(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace orbitutte
