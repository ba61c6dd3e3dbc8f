// SPDX-License-Identifier: MIT
// What a mesh is, and everything that is wrong with it.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/polygon_mesh.h"

namespace orbitutte {

enum class DefectKind {
  empty_mesh,
  index_out_of_range,
  non_finite_position,
  too_few_corners,          ///< a face with fewer than three corners
  repeated_vertex,          ///< a face that names a vertex twice
  duplicate_face,
  non_manifold_edge,        ///< more than two faces on an edge
  non_manifold_vertex,      ///< the faces of a vertex are not one fan
  inconsistent_orientation, ///< two faces run through an edge in the same direction, and no turning of faces helps or is done
  several_components,
  holes,                    ///< more than one boundary curve
  genus,
  not_orientable
};

/// The name of a defect, as in the JSON of `orbitutte info`: "non_manifold_edge" and so on.
std::string name(DefectKind kind);

/// One defect: the sentence names the first offending vertex, edge or face, and says what to do about it.
struct Defect {
  DefectKind kind;
  std::string message;
  long long count = 1;  ///< how many vertices, edges, faces, components or boundary curves are concerned
};

enum class Topology { sphere, disk, projective_plane, other };

/// "sphere", "disk", "projective-plane" or "other".
std::string name(Topology topology);

struct Inspection {
  int vertices = 0;
  int unreferenced_vertices = 0;  ///< allowed: they keep their index
  int edges = 0;
  int faces = 0;
  int triangles = 0;
  int max_face_degree = 0;
  int zero_area_faces = 0;  ///< allowed
  int components = 0;
  int euler_characteristic = 0;  ///< of the referenced vertices, edges and faces
  int genus = 0;                 ///< of an orientable surface in one piece, its holes closed; otherwise 0
  bool orientable = true;
  std::vector<std::vector<int>> boundary;  ///< boundary curves as vertex loops along the faces' half-edges, longest first
  Topology topology = Topology::other;     ///< other, wherever a defect stands in the way

  // Quality of the triangles, zero-area faces left out.
  double area = 0;
  double min_angle = 0;              ///< radians
  double max_angle = 0;              ///< radians
  double min_edge_length = 0;
  double max_edge_length = 0;
  int negative_cotangent_edges = 0;  ///< edges whose cotangent weight is negative: clamped by the default weights
  int zero_cotangent_edges = 0;

  std::vector<Defect> defects;  ///< all of them, in the order in which they should be mended
};

/// Looks at everything, in time O(n log n), and never throws on account of the mesh. Where indices are out of range or
/// coordinates not finite, what depends on them is left at zero.
Inspection inspect(const PolygonMesh& mesh);

/// The same for triangles.
Inspection inspect(const Mesh& mesh);

/// Throws MeshError with the first defect's sentence; does nothing on a sphere, disk or projective plane.
void require_embeddable(const Inspection& inspection);

}  // namespace orbitutte
