// SPDX-License-Identifier: MIT
// What a mesh is, and everything that is wrong with it.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/names.h"

namespace orbitutte {

/// In the order in which defects are reported and should be mended.
enum class DefectKind {
  empty_mesh,           ///< no vertices or no faces
  index_out_of_range,   ///< a face names a vertex that the mesh does not have
  non_finite_position,  ///< a coordinate is infinite or no number
  size_out_of_range,    ///< coordinates so large, or a mesh so small, that squared lengths are no doubles
  too_few_corners,      ///< a face with fewer than three corners
  repeated_vertex,      ///< a face that names a vertex twice
  duplicate_face,       ///< a face with the same vertices as an earlier one
  non_manifold_edge,    ///< more than two faces on an edge
  non_manifold_vertex,  ///< the faces of a vertex are not one fan
  inconsistent_orientation,  ///< two faces run through an edge in the same direction; turning faces mends it
  several_components,
  holes,           ///< more than one boundary curve
  genus,           ///< handles
  not_orientable,  ///< and no projective plane: no turning of faces makes them agree
  no_area          ///< no face has any: all vertices at one point, say
};

/// Its names.
template <>
struct NameTable<DefectKind> {
  static constexpr NamedValue<DefectKind> rows[] = {
      {DefectKind::empty_mesh, "empty_mesh"},
      {DefectKind::index_out_of_range, "index_out_of_range"},
      {DefectKind::non_finite_position, "non_finite_position"},
      {DefectKind::size_out_of_range, "size_out_of_range"},
      {DefectKind::too_few_corners, "too_few_corners"},
      {DefectKind::repeated_vertex, "repeated_vertex"},
      {DefectKind::duplicate_face, "duplicate_face"},
      {DefectKind::non_manifold_edge, "non_manifold_edge"},
      {DefectKind::non_manifold_vertex, "non_manifold_vertex"},
      {DefectKind::inconsistent_orientation, "inconsistent_orientation"},
      {DefectKind::several_components, "several_components"},
      {DefectKind::holes, "holes"},
      {DefectKind::genus, "genus"},
      {DefectKind::not_orientable, "not_orientable"},
      {DefectKind::no_area, "no_area"}};
};

/// One defect: the sentence names the first offending vertex, edge or face, and says what to do about it.
struct Defect {
  DefectKind kind;
  std::string message;
  long long count =
      1;  ///< how many vertices, edges, faces, components, boundary curves or handles are concerned
};

/// What was found out about a mesh.
struct Inspection {
  int vertices = 0;
  int unreferenced_vertices = 0;  ///< allowed: they keep their index
  int faces = 0;
  int triangles = 0;
  int max_face_degree = 0;

  // The surface of the well-formed faces: three corners or more, all different and in range; a face given
  // twice counts once. Vertices are connected through the corners of all faces.
  int edges = 0;
  int components =
      0;  ///< in one piece as a set of points: parts that share no more than a vertex are one component
  int euler_characteristic =
      0;  ///< of the referenced vertices, edges and faces; 0 where a face is not well-formed

  // What is known of surfaces only: left as here where an edge or a vertex is not manifold or a face not
  // well-formed.
  int genus = 0;  ///< of an orientable surface in one piece, its holes closed; otherwise 0
  bool orientable = true;
  std::vector<std::vector<int>> boundary;  ///< boundary curves as vertex loops along the faces' half-edges,
                                           ///< each from its smallest vertex, longest first
  Topology topology = Topology::other;     ///< other, wherever a defect stands in the way
  /// Of a disk: that vertices of its boundary are at the same point, or nearly, as along a texture's seam,
  /// and what to do if a sphere is meant; empty if there are none.
  std::string welding_advice;

  // Quality of the faces, those without area left out; all zero if a coordinate is not finite or out of
  // range. The area of a polygon is that of its vector, half the sum of its corners' cross products.
  int zero_area_faces = 0;  ///< with no area but rounding errors; allowed, if not all are
  double area = 0;
  double min_angle = 0;  ///< of a face at a corner: radians
  double max_angle = 0;  ///< radians; above pi where a polygon bends inwards
  double min_edge_length = 0;
  double max_edge_length = 0;
  int negative_cotangent_edges = 0;  ///< between triangles: cotangent weight (cot a + cot b)/2 below zero,
                                     ///< clamped by the weights `cotan`
  int zero_cotangent_edges = 0;      ///< between triangles: cotangent weight zero up to rounding errors

  std::vector<Defect>
      defects;  ///< all of them, in the order in which they should be mended; one of each kind
};

/// Looks at everything, in time O(n log n), and never throws on account of the mesh. What a defect makes
/// meaningless is neither claimed nor counted: a surface with an edge of three faces has no genus. Throws
/// ArgumentError only where the face_start of `mesh` are not ascending offsets into its corners.
Inspection inspect(const PolygonMesh& mesh);

/// The same for triangles.
Inspection inspect(const Mesh& mesh);

/// Throws MeshError with the first defect's sentence; does nothing on a sphere, disk or projective plane.
void require_embeddable(const Inspection& inspection);

}  // namespace orbitutte
