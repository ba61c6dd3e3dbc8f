// SPDX-License-Identifier: MIT
// Where a mesh is not 3-connected, so that Tutte's theorem promises nothing: no defects, since much of it may
// come out well, by the choice of the marked vertices or as straight corners.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/names.h"

namespace orbitutte {

enum class WeakPlaceKind {
  degree_two,     ///< a vertex inside with two edges: it comes to lie straight between its neighbours
  ear,            ///< a face with all edges but one on the boundary: an arc, where these lie on one mirror
  chord,          ///< an edge inside that joins two vertices of the boundary, and cuts off more than an ear
  boundary_face,  ///< a face that meets the boundary in several places, with no chord between them
  double_contact  ///< two faces that share vertices which no common edge joins
};

/// Its names.
template <>
struct NameTable<WeakPlaceKind> {
  static constexpr NamedValue<WeakPlaceKind> rows[] = {{WeakPlaceKind::degree_two, "degree_two"},
                                                       {WeakPlaceKind::ear, "ear"},
                                                       {WeakPlaceKind::chord, "chord"},
                                                       {WeakPlaceKind::boundary_face, "boundary_face"},
                                                       {WeakPlaceKind::double_contact, "double_contact"}};
};

/// All places of one kind: the sentence names the first.
struct WeakPlace {
  WeakPlaceKind kind;
  std::string message;
  long long count = 1;
};

/// One of each kind that there is, in the order of the kinds; O(c log c) for c corners. The mesh is expected
/// to have passed `inspect`.
std::vector<WeakPlace> find_weak_places(int vertex_count, const FaceView& faces);
std::vector<WeakPlace> find_weak_places(const PolygonMesh& mesh);

/// The faces that must become arcs or points, ascending, whatever the solver does. `mirrors` are stretches of
/// the boundary, each in the order of the faces' half-edges, whose vertices stay on one great circle. A chord
/// or a face with two vertices on the same mirror cuts off a part that collapses onto the mirror; two faces
/// with a double contact enclose one that collapses onto an arc; unless a vertex of `marks` lies in it.
std::vector<int> collapsing_faces(const FaceView& faces, const std::vector<std::vector<int>>& mirrors,
                                  const std::vector<int>& marks);

}  // namespace orbitutte
