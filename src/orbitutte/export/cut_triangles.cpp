// SPDX-License-Identifier: MIT
#include "orbitutte/export/cut_triangles.h"

#include <utility>

namespace orbitutte {
namespace {

// Does face f of the cut mesh have the corners of the input's face, in either direction from the same corner
// on?
bool is_cut_face(const Surface& surface, const Embedding& embedding, int f) {
  const std::span<const int> face = surface.faces()[f], cut = embedding.faces()[f];
  if (cut.size() != face.size()) return false;
  const int vertices = static_cast<int>(embedding.source_vertex.size());
  for (const int v : cut)
    if (v < 0 || v >= vertices) return false;
  for (int k = 0; k < static_cast<int>(face.size()); ++k)
    if (embedding.source_vertex[cut[cut_corner(surface, embedding, f, k)]] != face[k]) return false;
  return true;
}

bool is_cut_from(const Surface& surface, const Embedding& embedding) {
  const auto vertices = static_cast<Eigen::Index>(embedding.source_vertex.size());
  if (embedding.positions.rows() != vertices || vertices < surface.V.rows()) return false;
  const int faces = surface.faces().count();
  if (embedding.faces().count() != faces) return false;
  for (int f = 0; f < faces; ++f)
    if (!is_cut_face(surface, embedding, f)) return false;
  return true;
}

}  // namespace

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

void require_cut_from(const Surface& surface, const Embedding& embedding) {
  if (!is_cut_from(surface, embedding))
    throw MeshError("the embedding does not belong to this mesh; give the mesh that was embedded");
}

}  // namespace orbitutte
