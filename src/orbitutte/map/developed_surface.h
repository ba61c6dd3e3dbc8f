// SPDX-License-Identifier: MIT
// An embedded surface as a walker sees it: triangles with corners of all digits, and the element of the group
// by which the next triangle goes on across every half-edge. Private to map/.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/map/placed_points.h"

namespace orbitutte {

/// The uncut surface of an embedding. Half-edges are those of Embedding::triangles. Positions are in the
/// frame of the embedding's, each triangle's in one piece; the triangle beyond half-edge h goes on at the
/// element beyond[h] times its own positions.
struct DevelopedSurface {
  /// T x 3, cut vertices, which are also the sites.
  Triangles triangles;

  /// n_cut: the input vertex.
  std::vector<int> source_vertex;

  /// 3 T: the half-edge on the other side, or -1 on the boundary; and the element.
  std::vector<int> opposite, beyond;

  /// 3 T: the undirected edge, and for each the half-edge that stands for it: the lower one.
  std::vector<int> edge, reference;

  /// n: a half-edge that begins at the input vertex, on the boundary if the vertex is; -1 if no triangle uses
  /// it.
  std::vector<int> first_halfedge;

  Sites sites;

  int triangle_count() const { return static_cast<int>(triangles.rows()); }
  int edge_count() const { return static_cast<int>(reference.size()); }
  int vertex_count() const { return static_cast<int>(first_halfedge.size()); }

  /// The cut vertex where a half-edge begins, and its input vertex.
  int site_of(int h) const { return triangles.data()[h]; }
  int vertex_of(int h) const { return source_vertex[triangles.data()[h]]; }

  /// The half-edge of a triangle that begins at an input vertex, or lies on an edge; -1 for none.
  int corner_at(int triangle, int vertex) const;
  int halfedge_on(int triangle, int edge) const;
};

/// The surface of an embedding, with positions of all digits where copies meet: a vertex that the group holds
/// is the fixed point of what holds it, one on a mirror lies on it, and copies are the images of one of them.
/// `name` is what messages call the surface. Throws ArgumentError if the boundary is not glued by elements of
/// the group that keep orientations, or by mirrors; MeshError naming a triangle that is not positive.
DevelopedSurface developed_surface(const Embedding& embedding, const SharedGroup& group,
                                   ElementTable& elements, const std::string& name);

}  // namespace orbitutte
