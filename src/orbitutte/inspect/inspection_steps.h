// SPDX-License-Identifier: MIT
// What the steps of `inspect` share: polygons with their edges, and how defects are recorded.
#pragma once

#include <algorithm>
#include <string>
#include <vector>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/mesh/disjoint_sets.h"
#include "orbitutte/mesh/groups.h"

namespace orbitutte::inspection {

enum class FaceState : unsigned char { well_formed, malformed, duplicate };

// The polygons with their half-edges: half-edge h runs from corner h to the next corner of the same face.
struct InspectedMesh {
  const PolygonMesh& mesh;
  /// Of every corner.
  std::vector<int> face_of;
  /// Of every face.
  std::vector<FaceState> state;
  /// Of every face: another one has the same vertices.
  std::vector<char> has_double;
  /// Half-edges of well-formed faces by undirected edge, in lexicographic order of (lower, upper) vertex.
  Groups edges;

  explicit InspectedMesh(const PolygonMesh& polygons)
      : mesh(polygons),
        face_of(polygons.corners.size()),
        state(polygons.face_count(), FaceState::well_formed),
        has_double(polygons.face_count(), 0) {
    for (int f = 0; f < mesh.face_count(); ++f)
      std::fill(face_of.begin() + mesh.face_start[f], face_of.begin() + mesh.face_start[f + 1], f);
  }

  int corner_count() const { return static_cast<int>(mesh.corners.size()); }
  bool well_formed(int f) const { return state[f] == FaceState::well_formed; }

  int next(int h) const {
    const int f = face_of[h];
    return h + 1 < mesh.face_start[f + 1] ? h + 1 : mesh.face_start[f];
  }
  int origin(int h) const { return mesh.corners[h]; }
  int target(int h) const { return mesh.corners[next(h)]; }
  int lower(int h) const { return std::min(origin(h), target(h)); }
  int upper(int h) const { return std::max(origin(h), target(h)); }

  int edge_count() const { return edges.size(); }
  int faces_on(int e) const { return edges.start[e + 1] - edges.start[e]; }
  int half_edge(int e, int i) const { return edges.items[edges.start[e] + i]; }
  bool runs_twice(int e) const { return origin(half_edge(e, 0)) == origin(half_edge(e, 1)); }

  // The corner at vertex v of the face of half-edge h, which begins or ends there.
  int corner_at(int v, int h) const { return origin(h) == v ? h : next(h); }
};

inline bool in_range(const PolygonMesh& mesh, int vertex) {
  return vertex >= 0 && vertex < mesh.vertex_count();
}

// The corners of every face in ascending order of their vertices: faces with the same vertices have the same.
std::vector<int> sorted_corners(const PolygonMesh& mesh);

// For each well-formed face, the first one with the same vertices, most often itself; -1 for the others.
std::vector<int> first_doubles(const InspectedMesh& inspected, const std::vector<int>& sorted);

// Fills `edges`.
void find_edges(InspectedMesh& inspected);

// Corners of well-formed faces, united across edges of two faces: a fan of faces around a vertex is one set.
DisjointSets corner_fans(const InspectedMesh& inspected);

// The steps, in their order. Each reports one kind of defect, or a few related ones, and leaves out what
// earlier defects have made meaningless.
void inspect_faces(InspectedMesh& inspected, Inspection& result);
void inspect_topology(InspectedMesh& inspected, Inspection& result);
void inspect_quality(const InspectedMesh& inspected, Inspection& result);

void add(Inspection& result, DefectKind kind, long long count, std::string message);
bool has(const Inspection& result, DefectKind kind);

/// " (12 such edges)", or nothing for one.
std::string such(long long count, const char* plural);

/// "3", "3, 5 and 8", "3, 5, 8, 9, 11 and 24 more".
std::string listed(const std::vector<int>& numbers);

}  // namespace orbitutte::inspection
