// SPDX-License-Identifier: MIT
// The common refinement of two surfaces that are embedded into one target: the bijection between them as a
// mesh.
#pragma once

#include <memory>
#include <vector>

#include "orbitutte/map/point_map.h"
#include "orbitutte/orbifold/embedding.h"

namespace orbitutte {

/// What a vertex of an overlay is: a vertex of A, a vertex of B, both, or where an edge of A crosses one of
/// B.
struct OverlayVertex {
  /// Vertices of the inputs; -1 for none.
  int a_vertex = -1, b_vertex = -1;

  /// Half-edges of Embedding::triangles (3 t + k, from corner k of triangle t to the next one) that the
  /// vertex lies on, but not at an end; -1 for none. Of an edge inside the surface it is either of the two.
  int a_halfedge = -1, b_halfedge = -1;
};

/// A face of an overlay: where a triangle of A meets one of B.
struct OverlayFace {
  /// Rows of Embedding::triangles of A and of B.
  int a = -1, b = -1;

  /// Which of Overlay::placements takes the triangle of B to where it meets that of A.
  int placement = 0;
};

/// The mesh whose vertices are those of A, those of B and the crossings of their edges. Every face is a
/// convex polygon of at most six corners, in one triangle of A and in one of B. On each of its faces the map
/// from A to B is projective: barycentric coordinates are in proportion to linear functions of each other.
struct Overlay {
  std::vector<OverlayVertex> vertices;

  /// Where each vertex lies on A and on B (SurfacePoints::copy is empty).
  SurfacePoints on_a, on_b;

  /// Counterclockwise.
  Polygons faces;

  /// One for each face.
  std::vector<OverlayFace> parents;

  /// From the frame of B's positions to that of A's.
  std::vector<Isometry> placements;

  /// If a triangle of A or of B has two edges on one mirror, which make it flat on the target: the overlay of
  /// both surfaces with such triangles divided (divided_ears.h), which this one has its vertices and faces
  /// from. Some faces go on inside of both their parents then, and some vertices lie inside of them.
  std::shared_ptr<const Overlay> of_parts;

  int vertex_count() const { return static_cast<int>(vertices.size()); }
  int face_count() const { return faces.count(); }
};

/// The overlay of two certified embeddings into the same target: the same signature, with the same tile in
/// the canonical frame, the marks corresponding in their order (Embedding::cones). Marked vertices lie on
/// each other as the list says; all others are where exact signs put them.
///
/// Everything is decided by the signs of determinants of three points (and, of two crossings on one edge, by
/// the order of such), which are exact: a filter in doubles, another in two doubles, and numbers of 320 bits
/// or, where positions have offsets, of 2304 bits. Points are the stored positions of the input vertices
/// moved by precise elements of the group, so that nothing depends on which copy of a vertex a seam has;
/// marks are the fixed points of their elements, and vertices on a mirror lie on its line. Edges of B are
/// traced through A from a located end; across half-edge h of A the element G of the group that B is placed
/// by becomes G_h^-1 G.
///
/// Coincidences are no special case of the geometry and are not perturbed: a vertex on a vertex is one
/// vertex, a vertex on an edge divides it, edges that run along each other are one edge. That is consistent
/// since signs are those of one exact configuration in which the triangles of A do not overlap, nor do those
/// of B: what is zero for one triangle is zero for its neighbours, too. Only signs of numbers below 2^-250
/// (relative), which no stored position tells from zero, count as zero. The boundaries of disks run along
/// each other in this way.
///
/// A triangle with two edges on one mirror is flat on the target. It is divided from the middle of its third
/// edge, as is the triangle behind that edge, so that the map is one to one there, too (Overlay::of_parts).
///
/// O((n_A + n_B + crossings) log) time. Throws ArgumentError if the targets differ, are no surface with the
/// topology of a sphere or a disk (projective planes, fixed polygons), or the tiles are not the same; and
/// MeshError naming a face of A or B that is not positive, if an embedding is not certified.
Overlay overlay(const Embedding& a, const Embedding& b);

/// The positions in space (k x 3) of points on a surface. V: n x 3, the vertices of the input; `embedding` is
/// of that surface.
Points positions_on(const Points& V, const Embedding& embedding, const SurfacePoints& points);

/// An overlay in triangles.
struct OverlayTriangles {
  /// T x 3, vertices of the overlay.
  Triangles triangles;

  /// T: the face that each is of.
  std::vector<int> face;
};

/// The faces divided into triangles from their first corners.
OverlayTriangles overlay_triangles(const Overlay& overlay);

}  // namespace orbitutte
