// SPDX-License-Identifier: MIT
// Small meshes for tests, and what can be done to them. All closed ones and disks are counterclockwise seen
// from outside or above.
#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "orbitutte/mesh/subdivision.h"
#include "orbitutte/mesh/surface.h"
#include "orbitutte/mesh/triangulation.h"

namespace orbitutte::test {

inline Mesh mesh(const std::vector<Vector3>& points, const std::vector<std::vector<int>>& triangles) {
  Mesh result;
  result.V.resize(static_cast<Eigen::Index>(points.size()), 3);
  result.F.resize(static_cast<Eigen::Index>(triangles.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) result.V.row(v) = points[v];
  for (std::size_t f = 0; f < triangles.size(); ++f)
    result.F.row(f) << triangles[f][0], triangles[f][1], triangles[f][2];
  return result;
}

inline int vertex_count(const Mesh& mesh) { return static_cast<int>(mesh.V.rows()); }
inline int face_count(const Mesh& mesh) { return static_cast<int>(mesh.F.rows()); }
inline Connectivity edges_of(const Mesh& mesh) { return connectivity_of(mesh.F, vertex_count(mesh)); }

/// The mesh as a surface that nobody has judged: for planted faults, which make_surface would refuse.
inline Surface unjudged(const Mesh& mesh) {
  Surface surface;
  surface.V = mesh.V;
  surface.triangles = mesh.F;
  surface.connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  return surface;
}
inline Surface unjudged(const PolygonMesh& mesh) {
  Surface surface;
  surface.V = mesh.V;
  surface.division = triangulate(mesh);
  surface.triangles = triangles_on_vertices(surface.division, mesh.corners);
  surface.connectivity = connectivity_of(mesh, surface.division);
  surface.polygons = {mesh.corners, mesh.face_start};
  return surface;
}

// Spheres

/// 4 vertices, 4 faces.
inline Mesh tetrahedron() {
  return mesh({{1, 1, 1}, {-1, -1, 1}, {-1, 1, -1}, {1, -1, -1}},
              {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// 6 vertices on the axes, 8 faces.
inline Mesh octahedron() {
  return mesh({{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}},
              {{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}});
}

/// 12 vertices on the unit sphere, vertex 11 - i opposite to i; 20 faces.
inline Mesh icosahedron() {
  const double r = (1 + std::sqrt(5)) / 2;
  Mesh result = mesh({{0, 1, r},
                      {0, -1, r},
                      {1, r, 0},
                      {-1, r, 0},
                      {r, 0, 1},
                      {-r, 0, 1},
                      {r, 0, -1},
                      {-r, 0, -1},
                      {1, -r, 0},
                      {-1, -r, 0},
                      {0, 1, -r},
                      {0, -1, -r}},
                     {{0, 1, 4}, {0, 4, 2},  {0, 2, 3},  {0, 3, 5},  {0, 5, 1},   {1, 5, 9},  {1, 9, 8},
                      {1, 8, 4}, {4, 8, 6},  {4, 6, 2},  {2, 6, 10}, {2, 10, 3},  {3, 10, 7}, {3, 7, 5},
                      {5, 7, 9}, {11, 6, 8}, {11, 8, 9}, {11, 9, 7}, {11, 7, 10}, {11, 10, 6}});
  result.V.rowwise().normalize();
  return result;
}

inline Mesh sphere_from(Mesh solid, int levels) {
  for (int level = 0; level < levels; ++level) {
    solid = subdivided(solid);
    solid.V.rowwise().normalize();
  }
  return solid;
}

/// On the unit sphere, 20 * 4^levels faces; the first 12 vertices are the icosahedron's.
inline Mesh icosphere(int levels) { return sphere_from(icosahedron(), levels); }

/// On the unit sphere, 8 * 4^levels faces; the first 6 vertices are the octahedron's.
inline Mesh octasphere(int levels) { return sphere_from(octahedron(), levels); }

// Disks and strips

/// The rectangle [0, columns] x [0, rows] in unit squares of two triangles; vertex (column x, row y) has the
/// number y (columns + 1) + x.
inline Mesh grid_disk(int columns, int rows) {
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  for (int y = 0; y <= rows; ++y)
    for (int x = 0; x <= columns; ++x) points.emplace_back(x, y, 0);
  for (int y = 0; y < rows; ++y) {
    for (int x = 0; x < columns; ++x) {
      const int a = y * (columns + 1) + x, b = a + 1, d = a + columns + 1, c = d + 1;
      triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  return mesh(points, triangles);
}

/// The unit disk: vertex 0 at the centre, then rings of 6, 12, 18, ... vertices.
inline Mesh round_disk(int rings) {
  std::vector<Vector3> points = {Vector3::Zero()};
  std::vector<std::vector<int>> triangles;
  const auto vertex = [](int ring, int i) {
    return ring == 0 ? 0 : 3 * ring * (ring - 1) + 1 + i % (6 * ring);
  };
  for (int ring = 1; ring <= rings; ++ring) {
    for (int i = 0; i < 6 * ring; ++i) {
      const double angle = std::numbers::pi * i / (3 * ring), radius = double(ring) / rings;
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    }
    for (int side = 0; side < 6; ++side) {
      for (int i = 0; i < ring; ++i) {
        const int outer = side * ring + i, inner = side * (ring - 1) + i;
        triangles.push_back({vertex(ring, outer), vertex(ring, outer + 1), vertex(ring - 1, inner)});
        if (i + 1 < ring)
          triangles.push_back(
              {vertex(ring, outer + 1), vertex(ring - 1, inner + 1), vertex(ring - 1, inner)});
      }
    }
  }
  return mesh(points, triangles);
}

/// A flat ring of `around` squares, between the radii 1 and 2: two boundary curves of `around` edges each.
inline Mesh annulus(int around) {
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    for (const double radius : {1.0, 2.0})
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), 0);
    const int a = 2 * i, b = a + 1, d = 2 * ((i + 1) % around), c = d + 1;
    triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
  }
  return mesh(points, triangles);
}

/// `around` squares (three or more) with half a turn: one boundary curve of 2 `around` edges.
inline Mesh moebius_strip(int around) {
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  for (int i = 0; i < around; ++i) {
    const double angle = 2 * std::numbers::pi * i / around;
    for (const double s : {-0.5, 0.5}) {
      const double radius = 2 + s * std::cos(angle / 2);
      points.emplace_back(radius * std::cos(angle), radius * std::sin(angle), s * std::sin(angle / 2));
    }
    const bool last = i + 1 == around;
    const int a = 2 * i, b = a + 1, d = last ? 1 : a + 2, c = last ? 0 : a + 3;
    triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
  }
  return mesh(points, triangles);
}

// Closed surfaces that are no spheres

/// around x across squares, three or more each.
inline Mesh torus(int around, int across) {
  std::vector<Vector3> points;
  std::vector<std::vector<int>> triangles;
  const auto vertex = [=](int i, int j) { return (i % around) * across + j % across; };
  for (int i = 0; i < around; ++i) {
    for (int j = 0; j < across; ++j) {
      const double u = 2 * std::numbers::pi * i / around, v = 2 * std::numbers::pi * j / across,
                   r = 3 + std::cos(v);
      points.emplace_back(r * std::cos(u), r * std::sin(u), std::sin(v));
      const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
      triangles.insert(triangles.end(), {{a, b, c}, {a, c, d}});
    }
  }
  return mesh(points, triangles);
}

/// around x across squares, three or more each, glued with a mirror: not orientable, Euler characteristic 0.
/// The positions are those of a torus and mean nothing.
inline Mesh klein_bottle(int around, int across) {
  Mesh result = torus(around, across);
  const auto vertex = [=](int i, int j) {
    return i < around ? i * across + j % across : (2 * across - j) % across;
  };
  for (int j = 0; j < across; ++j) {
    const int i = around - 1, f = 2 * (i * across + j);
    const int a = vertex(i, j), b = vertex(i + 1, j), c = vertex(i + 1, j + 1), d = vertex(i, j + 1);
    result.F.row(f) << a, b, c;
    result.F.row(f + 1) << a, c, d;
  }
  return result;
}

/// The icosphere with opposite points taken as one, 10 * 4^levels faces: the projective plane, for levels = 0
/// with its least number of vertices, 6. Positions on Steiner's Roman surface.
inline Mesh projective_plane(int levels) {
  const Mesh sphere = icosphere(levels);
  const auto key = [&](int v, double sign) {
    const auto rounded = [](double x) { return std::llround(x * 1e6); };
    return std::array<long long, 3>{rounded(sign * sphere.V(v, 0)), rounded(sign * sphere.V(v, 1)),
                                    rounded(sign * sphere.V(v, 2))};
  };
  std::map<std::array<long long, 3>, int> vertex_at;
  std::vector<int> image(vertex_count(sphere));
  std::vector<Vector3> points;
  for (int v = 0; v < vertex_count(sphere); ++v) {
    if (const auto at = vertex_at.find(key(v, -1)); at != vertex_at.end()) {
      image[v] = at->second;
      continue;
    }
    image[v] = vertex_at[key(v, 1)] = static_cast<int>(points.size());
    const double x = sphere.V(v, 0), y = sphere.V(v, 1), z = sphere.V(v, 2);
    points.emplace_back(y * z, x * z, x * y);
  }
  std::map<std::vector<int>, std::vector<int>> triangles;
  for (int f = 0; f < face_count(sphere); ++f) {
    const std::vector<int> face = {image[sphere.F(f, 0)], image[sphere.F(f, 1)], image[sphere.F(f, 2)]};
    std::vector<int> sorted = face;
    std::sort(sorted.begin(), sorted.end());
    triangles.emplace(sorted, face);
  }
  std::vector<std::vector<int>> faces;
  for (const auto& [sorted, face] : triangles) faces.push_back(face);
  return mesh(points, faces);
}

// Changes

/// Both, unconnected; the vertices and faces of b follow those of a.
inline Mesh united(const Mesh& a, const Mesh& b) {
  Mesh result;
  result.V.resize(a.V.rows() + b.V.rows(), 3);
  result.V << a.V, b.V;
  result.F.resize(a.F.rows() + b.F.rows(), 3);
  result.F << a.F, (b.F.array() + vertex_count(a)).matrix();
  return result;
}

/// Vertex w is now vertex v in all faces, and unreferenced.
inline Mesh with_vertices_merged(Mesh mesh, int v, int w) {
  mesh.F = mesh.F.unaryExpr([=](int u) { return u == w ? v : u; });
  return mesh;
}

inline Mesh with_face(Mesh mesh, int a, int b, int c) {
  mesh.F.conservativeResize(mesh.F.rows() + 1, 3);
  mesh.F.bottomRows(1) << a, b, c;
  return mesh;
}

inline Mesh without_faces(const Mesh& mesh, std::vector<int> faces) {
  Mesh result = mesh;
  int kept = 0;
  for (int f = 0; f < face_count(mesh); ++f) {
    if (std::find(faces.begin(), faces.end(), f) == faces.end()) result.F.row(kept++) = mesh.F.row(f);
  }
  result.F.conservativeResize(kept, 3);
  return result;
}

inline Mesh with_face_turned(Mesh mesh, int f) {
  std::swap(mesh.F(f, 1), mesh.F(f, 2));
  return mesh;
}

/// Old vertex v is new vertex new_number[v].
inline Mesh relabelled(const Mesh& mesh, const std::vector<int>& new_number) {
  Mesh result = mesh;
  for (int v = 0; v < vertex_count(mesh); ++v) result.V.row(new_number[v]) = mesh.V.row(v);
  result.F = mesh.F.unaryExpr([&](int v) { return new_number[v]; });
  return result;
}

/// New face i is old face old_face[i].
inline Mesh reordered(const Mesh& mesh, const std::vector<int>& old_face) {
  Mesh result = mesh;
  for (int f = 0; f < face_count(mesh); ++f) result.F.row(f) = mesh.F.row(old_face[f]);
  return result;
}

/// The numbers 0 .. n-1 in an order that the seed alone decides.
inline std::vector<int> permutation(int n, std::uint32_t seed) {
  std::vector<int> result(n);
  for (int i = 0; i < n; ++i) result[i] = i;
  std::mt19937 random(seed);
  for (int i = n - 1; i > 0; --i) std::swap(result[i], result[random() % (i + 1)]);
  return result;
}

/// Every coordinate moved by up to `amount`, as the seed alone decides.
inline Mesh perturbed(Mesh mesh, double amount, std::uint32_t seed) {
  std::mt19937 random(seed);
  for (double& x : mesh.V.reshaped()) x += amount * (2.0 * random() / std::mt19937::max() - 1);
  return mesh;
}

// Polygons

inline PolygonMesh polygon_mesh(const std::vector<Vector3>& points,
                                const std::vector<std::vector<int>>& polygons) {
  PolygonMesh result;
  result.V = mesh(points, {}).V;
  for (const auto& polygon : polygons) {
    result.corners.insert(result.corners.end(), polygon.begin(), polygon.end());
    result.face_start.push_back(static_cast<int>(result.corners.size()));
  }
  return result;
}

/// 8 vertices, 6 quadrilaterals.
inline PolygonMesh cube() {
  return polygon_mesh(
      {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}},
      {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}});
}

}  // namespace orbitutte::test
