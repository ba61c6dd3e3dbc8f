// SPDX-License-Identifier: MIT
#include "orbitutte/export/cut_triangles.h"

#include <utility>

namespace orbitutte {

bool is_turned_face(const Surface& surface, const Embedding& embedding, int f) {
  return embedding.source_vertex[embedding.faces()[f][1]] != surface.faces()[f][1];
}

int cut_corner(const Surface& surface, const Embedding& embedding, int f, int k) {
  const int degree = surface.faces().degree(f);
  return is_turned_face(surface, embedding, f) ? (degree - k) % degree : k;
}

Triangles cut_triangles(const Surface& surface, const Embedding& embedding) {
  if (!surface.has_polygons()) return embedding.triangles;
  Triangles triangles(surface.triangle_count(), 3);
  const FaceView faces = surface.faces(), cut_faces = embedding.faces();
  int row = 0;
  for (int f = 0; f < faces.count(); ++f) {
    for (int t = 2; t < faces.degree(f); ++t, ++row) {
      for (int k = 0; k < 3; ++k) {
        const int corner = surface.division(row, k) - faces.start(f);
        triangles(row, k) = cut_faces[f][cut_corner(surface, embedding, f, corner)];
      }
      if (is_turned_face(surface, embedding, f)) std::swap(triangles(row, 1), triangles(row, 2));
    }
  }
  return triangles;
}

}  // namespace orbitutte
