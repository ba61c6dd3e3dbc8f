// SPDX-License-Identifier: MIT
// Places where a mesh is not 3-connected, so that Tutte's theorem promises nothing. They are not defects:
// with suitable marked vertices, or with straight corners, many of them do no harm.
#pragma once

#include <string>
#include <vector>

#include "orbitutte/mesh/polygon_mesh.h"
#include "orbitutte/names.h"

namespace orbitutte {

enum class WeakPlaceKind {
  /// A vertex inside with two edges; it comes to lie straight between its neighbours.
  degree_two,
  /// A face with all edges but one on the boundary; it becomes an arc if these lie on one mirror.
  ear,
  /// An edge inside that joins two vertices of the boundary, and cuts off more than an ear.
  chord,
  /// A face that meets the boundary in several places, with no chord between them.
  boundary_face,
  /// Two faces that share vertices not joined by a common edge.
  double_contact
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

/// All places of one kind; the message is about the first.
struct WeakPlace {
  WeakPlaceKind kind;
  std::string message;
  long long count = 1;
};

/// One entry for each kind that occurs, in the order of the kinds; O(c log c) for c corners. The mesh is
/// expected to have passed `inspect`.
std::vector<WeakPlace> find_weak_places(int vertex_count, const FaceView& faces);
std::vector<WeakPlace> find_weak_places(const PolygonMesh& mesh);

/// The faces that must become arcs or points, ascending, whatever the solver does. `mirrors` are stretches
/// of the boundary, each in the order of the faces' half-edges, whose vertices stay on one great circle. A
/// chord or a face with two vertices on the same mirror cuts off a part that collapses onto the mirror. Two
/// faces with a double contact enclose a part that collapses onto an arc. Neither happens if a vertex of
/// `marks` lies in the part.
std::vector<int> collapsing_faces(const FaceView& faces, const std::vector<std::vector<int>>& mirrors,
                                  const std::vector<int>& marks);

}  // namespace orbitutte
