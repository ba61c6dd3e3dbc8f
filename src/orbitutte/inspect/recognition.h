// SPDX-License-Identifier: MIT
// The surface that a mesh is, if it can be embedded.
#pragma once

#include <optional>

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/mesh/surface.h"

namespace orbitutte {

// The sizes of meshes whose squared lengths are doubles.
inline constexpr double largest_coordinate = 1e150;
inline constexpr double smallest_size = 1e-150;

/// The surface that a mesh is: a sphere, a disk or a projective plane. Throws MeshError with the first defect
/// that `inspect` finds. If a mesh is moved in, its memory becomes the surface's; a mesh with a defect stays
/// as it was.
Surface make_surface(Mesh&& mesh);
Surface make_surface(const Mesh& mesh);

/// The same of a mesh with faces of any number of corners, which are divided into triangles on the same
/// vertices (triangulate). Positions that are moved in are not copied.
Surface make_surface(PolygonMesh&& mesh);
Surface make_surface(const PolygonMesh& mesh);

/// The mesh as a sphere or disk, found in a few linear sweeps. Nothing if it is another surface or has a
/// defect of any kind; then the mesh stays as it was.
std::optional<Surface> recognize_sphere_or_disk(Mesh&& mesh);

/// Is the mesh a sphere without a defect, every vertex of which is in some face? Takes a few linear sweeps.
bool is_sound_sphere(const Mesh& mesh);

/// Does the triangle have no area but rounding errors, measured by the largest coordinate of its edges?
bool is_degenerate_triangle(const Vector3& a, const Vector3& b, const Vector3& c);

}  // namespace orbitutte
