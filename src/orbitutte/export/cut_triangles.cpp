// SPDX-License-Identifier: MIT
#include "orbitutte/export/cut_triangles.h"

#include <utility>

namespace orbitutte {

bool is_turned(const PolygonMesh& mesh, const Embedding& embedding, int f) {
  return embedding.source_vertex[embedding.input_faces()[f][1]] != mesh.corners[mesh.face_start[f] + 1];
}

int cut_corner(const PolygonMesh& mesh, const Embedding& embedding, int f, int k) {
  const int degree = mesh.face_degree(f);
  return is_turned(mesh, embedding, f) ? (degree - k) % degree : k;
}

Faces cut_triangles(const PolygonMesh& mesh, const Triangulation& triangulation, const Embedding& embedding) {
  Faces triangles(triangulation.corners.rows(), 3);
  const FaceView cut_faces = embedding.input_faces();
  int row = 0;
  for (int f = 0; f < mesh.face_count(); ++f) {
    for (int t = 2; t < mesh.face_degree(f); ++t, ++row) {
      for (int k = 0; k < 3; ++k) {
        const int corner = triangulation.corners(row, k) - mesh.face_start[f];
        triangles(row, k) = cut_faces[f][cut_corner(mesh, embedding, f, corner)];
      }
      if (is_turned(mesh, embedding, f)) std::swap(triangles(row, 1), triangles(row, 2));
    }
  }
  return triangles;
}

}  // namespace orbitutte
