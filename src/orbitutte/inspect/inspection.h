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
  /// No vertices or no faces.
  empty_mesh,
  /// A face names a vertex that the mesh does not have.
  index_out_of_range,
  /// A coordinate is infinite or not a number.
  non_finite_position,
  /// Coordinates are so large, or the mesh is so small, that doubles cannot hold squared lengths.
  size_out_of_range,
  /// A face with fewer than three corners.
  too_few_corners,
  /// A face that names a vertex twice.
  repeated_vertex,
  /// A face with the same vertices as an earlier one.
  duplicate_face,
  /// More than two faces on an edge.
  non_manifold_edge,
  /// The faces of a vertex are not one fan.
  non_manifold_vertex,
  /// Two faces run along an edge in the same direction; turning faces over mends it.
  inconsistent_orientation,
  several_components,
  /// More than one boundary curve.
  holes,
  /// Handles.
  genus,
  /// The faces cannot be turned so that all agree, and the surface is not a projective plane.
  not_orientable,
  /// No face has any area; for instance, all vertices are at one point.
  no_area
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
  /// The number of vertices, edges, faces, components, boundary curves or handles concerned.
  long long count = 1;
};

/// What is known of a mesh.
struct Inspection {
  int vertices = 0;
  /// They are allowed, and keep their index.
  int unreferenced_vertices = 0;
  int faces = 0;
  int triangles = 0;
  int max_face_degree = 0;

  // The surface of the well-formed faces: three corners or more, all different and in range; a face that is
  // given twice counts once. Vertices are connected through the corners of all faces.
  int edges = 0;
  /// Pieces of the set of points; parts that share only a vertex are one component.
  int components = 0;
  /// Of the referenced vertices, edges and faces; 0 if a face is not well-formed.
  int euler_characteristic = 0;

  // What is known of surfaces only. If an edge or a vertex is not manifold or a face is not well-formed, the
  // values stay as they are here.

  /// Of an orientable surface in one piece after its holes are closed; otherwise 0.
  int genus = 0;
  bool orientable = true;
  /// Boundary curves as loops of vertices along the faces' half-edges. Each begins at its smallest vertex;
  /// the longest comes first.
  std::vector<std::vector<int>> boundary;
  /// `other` if there is a defect.
  Topology topology = Topology::other;
  /// If vertices of a disk's boundary are at the same point, or nearly, as along a texture's seam: a
  /// sentence that says so, and what to do if a sphere is meant. Otherwise empty.
  std::string welding_advice;

  // Quality of the faces; faces without area are left out. All zero if a coordinate is not finite or out of
  // range. The area of a polygon is that of its vector, half the sum of its corners' cross products.

  /// Faces with no area but rounding errors. They are allowed unless all are like that.
  int zero_area_faces = 0;
  double area = 0;
  /// Of a face at a corner: radians.
  double min_angle = 0;
  /// Radians; above pi if a polygon bends inwards.
  double max_angle = 0;
  double min_edge_length = 0;
  double max_edge_length = 0;
  /// Edges between triangles whose cotangent weight (cot a + cot b)/2 is below zero; the weights `cotan`
  /// clamp them.
  int negative_cotangent_edges = 0;
  /// Edges between triangles whose cotangent weight is zero up to rounding errors.
  int zero_cotangent_edges = 0;

  /// All of them, in the order in which they should be mended; one of each kind.
  std::vector<Defect> defects;
};

/// Looks at everything, in time O(n log n), and never throws because of the mesh. If a defect makes a
/// quantity meaningless, the quantity is left out: a surface with an edge of three faces has no genus.
/// Throws ArgumentError only if mesh.face_start are not ascending offsets into its corners.
Inspection inspect(const PolygonMesh& mesh);

/// The same for triangles.
Inspection inspect(const Mesh& mesh);

/// Throws MeshError with the first defect's sentence; does nothing on a sphere, disk or projective plane.
void require_embeddable(const Inspection& inspection);

}  // namespace orbitutte
