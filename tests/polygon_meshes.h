// SPDX-License-Identifier: MIT
// Meshes with faces of more than three corners, and what can be done to them.
#pragma once

#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include "orbitutte/mesh/connectivity.h"
#include "test_meshes.h"

namespace orbitutte::test {

inline std::vector<std::vector<int>> face_lists(const PolygonMesh& mesh) {
  std::vector<std::vector<int>> result;
  for (int f = 0; f < mesh.face_count(); ++f)
    result.emplace_back(mesh.corners.begin() + mesh.face_start[f],
                        mesh.corners.begin() + mesh.face_start[f + 1]);
  return result;
}

inline std::vector<Vector3> point_list(const Points& V) {
  std::vector<Vector3> result;
  for (const auto& p : V.rowwise()) result.emplace_back(p);
  return result;
}

/// A vertex in the middle of every triangle of a closed mesh, a face around every vertex: all vertices have
/// three edges.
inline PolygonMesh dual(const Mesh& mesh) {
  const Connectivity connectivity = connectivity_of(mesh.F, vertex_count(mesh));
  std::vector<int> outgoing(vertex_count(mesh), -1);
  for (int h = 0; h < static_cast<int>(mesh.F.size()); ++h) outgoing[halfedge_origin(mesh.F, h)] = h;
  std::vector<Vector3> points;
  for (const auto& f : mesh.F.rowwise())
    points.push_back((mesh.V.row(f[0]) + mesh.V.row(f[1]) + mesh.V.row(f[2])) / 3);
  std::vector<std::vector<int>> faces;
  for (const int first : outgoing) {
    if (first < 0) continue;
    std::vector<int>& face = faces.emplace_back();
    int h = first;
    do {
      face.push_back(h / 3);
      h = connectivity.opposite[previous_halfedge(h)];
    } while (h != first);
  }
  return polygon_mesh(points, faces);
}

/// Every triangle in three quadrilaterals, which meet in its middle.
inline PolygonMesh quadrangulated(const Mesh& mesh) {
  std::vector<Vector3> points = point_list(mesh.V);
  std::map<std::pair<int, int>, int> midpoints;
  const auto midpoint = [&](int v, int w) {
    const auto [at, is_new] = midpoints.try_emplace(std::minmax(v, w), static_cast<int>(points.size()));
    if (is_new) points.push_back((points[v] + points[w]) / 2);
    return at->second;
  };
  std::vector<std::vector<int>> faces;
  for (const auto& f : mesh.F.rowwise()) {
    const int a = f[0], b = f[1], c = f[2];
    const int ab = midpoint(a, b), bc = midpoint(b, c), ca = midpoint(c, a),
              m = static_cast<int>(points.size());
    points.push_back((points[a] + points[b] + points[c]) / 3);
    faces.insert(faces.end(), {{a, ab, m, ca}, {b, bc, m, ab}, {c, ca, m, bc}});
  }
  return polygon_mesh(points, faces);
}

/// The rectangle [0, columns] x [0, rows] in unit squares; vertex (column x, row y) is y (columns + 1) + x.
inline PolygonMesh square_grid(int columns, int rows) {
  std::vector<std::vector<int>> faces;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const int a = y * (columns + 1) + x, d = a + columns + 1;
      faces.push_back({a, a + 1, d + 1, d});
    }
  return polygon_mesh(point_list(grid_disk(columns, rows).V), faces);
}

/// Two polygons of n corners, 0 .. n-1 below and n .. 2n-1 above, and the n squares between them.
inline PolygonMesh prism(int n) {
  std::vector<Vector3> points;
  std::vector<std::vector<int>> faces(2);
  for (const double z : {0.0, 1.0})
    for (int k = 0; k < n; ++k)
      points.emplace_back(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n), z);
  for (int k = 0; k < n; ++k) {
    faces[0].push_back(n - 1 - k);
    faces[1].push_back(n + k);
    faces.push_back({k, (k + 1) % n, n + (k + 1) % n, n + k});
  }
  return polygon_mesh(points, faces);
}

/// A polygon of n corners and the triangles to the apex n.
inline PolygonMesh pyramid(int n) {
  std::vector<Vector3> points;
  std::vector<std::vector<int>> faces(1);
  for (int k = 0; k < n; ++k)
    points.emplace_back(std::cos(2 * std::numbers::pi * k / n), std::sin(2 * std::numbers::pi * k / n), 0);
  points.emplace_back(0, 0, 1);
  for (int k = 0; k < n; ++k) {
    faces[0].push_back(n - 1 - k);
    faces.push_back({k, (k + 1) % n, n});
  }
  return polygon_mesh(points, faces);
}

/// A new vertex, the last one, in the middle of the edge (v, w) of all its faces.
inline PolygonMesh with_edge_divided(const PolygonMesh& mesh, int v, int w) {
  std::vector<Vector3> points = point_list(mesh.V);
  std::vector<std::vector<int>> faces = face_lists(mesh);
  const int middle = static_cast<int>(points.size());
  points.push_back((points[v] + points[w]) / 2);
  for (std::vector<int>& face : faces) {
    for (std::size_t k = 0; k < face.size(); ++k) {
      const int a = face[k], b = face[(k + 1) % face.size()];
      if (std::minmax(a, b) != std::minmax(v, w)) continue;
      face.insert(face.begin() + static_cast<std::ptrdiff_t>(k) + 1, middle);
      break;
    }
  }
  return polygon_mesh(points, faces);
}

}  // namespace orbitutte::test
