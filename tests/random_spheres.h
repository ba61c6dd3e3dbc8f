// SPDX-License-Identifier: MIT
// Triangulated spheres and projective planes as irregular as can be: small ones, their faces split and their
// edges flipped.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <vector>

#include "orbitutte/mesh/connectivity.h"
#include "test_meshes.h"

namespace orbitutte::test {

/// Face f in three, by a new vertex of degree three at its centroid: the last one.
inline Mesh with_face_split(Mesh mesh, int f) {
  const int a = mesh.F(f, 0), b = mesh.F(f, 1), c = mesh.F(f, 2), v = vertex_count(mesh);
  mesh.V.conservativeResize(v + 1, 3);
  mesh.V.row(v) = (mesh.V.row(a) + mesh.V.row(b) + mesh.V.row(c)) / 3;
  mesh.F.row(f) << a, b, v;
  return with_face(with_face(mesh, b, c, v), c, a, v);
}

inline Mesh with_all_faces_split(Mesh mesh) {
  const int faces = face_count(mesh);
  for (int f = 0; f < faces; ++f) mesh = with_face_split(mesh, f);
  return mesh;
}

/// The edge of half-edge h flipped, or the mesh as it was where the flipped edge exists already.
inline Mesh with_edge_flipped(Mesh mesh, int h) {
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  const int o = connectivity.opposite[h];
  const int a = halfedge_origin(mesh.F, h), b = halfedge_target(mesh.F, h),
            c = halfedge_origin(mesh.F, previous_halfedge(h)),
            d = halfedge_origin(mesh.F, previous_halfedge(o));
  const std::array<int, 2> flipped = {std::min(c, d), std::max(c, d)};
  if (std::binary_search(connectivity.edges.begin(), connectivity.edges.end(), flipped)) return mesh;
  mesh.F.row(h / 3) << a, d, c;
  mesh.F.row(o / 3) << d, b, c;
  return mesh;
}

/// Some faces split and some edges flipped, as the random numbers decide.
inline Mesh changed(Mesh mesh, int changes, std::mt19937& random) {
  for (int k = 0; k < changes; ++k) {
    const bool split = random() % 2 == 0;
    mesh = split ? with_face_split(mesh, static_cast<int>(random() % mesh.F.rows()))
                 : with_edge_flipped(mesh, static_cast<int>(random() % mesh.F.size()));
  }
  return mesh;
}

/// From a tetrahedron, octahedron or icosahedron; the seed alone decides.
inline Mesh random_sphere(std::uint32_t seed, int changes) {
  std::mt19937 random(seed);
  const std::array<Mesh, 3> solids = {tetrahedron(), octahedron(), icosahedron()};
  const Mesh& solid = solids[random() % 3];
  return changed(solid, changes, random);
}

/// From the projective plane of six vertices, its faces turned any way; the seed alone decides.
inline Mesh random_projective_plane(std::uint32_t seed, int changes) {
  std::mt19937 random(seed);
  Mesh mesh = changed(projective_plane(0), changes, random);
  for (int f = 0; f < face_count(mesh); ++f)
    if (random() % 2 == 0) mesh = with_face_turned(mesh, f);
  return mesh;
}

}  // namespace orbitutte::test
