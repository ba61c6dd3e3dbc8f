// SPDX-License-Identifier: MIT
// Defects of single vertices and faces, and faces that are given twice.
#include <fmt/format.h>

#include <algorithm>
#include <compare>
#include <utility>

#include "orbitutte/inspect/inspection_steps.h"
#include "orbitutte/inspect/recognition.h"

namespace orbitutte::inspection {
namespace {

// Well-formed faces in an order in which those with the same vertices are neighbours, the smallest face
// first.
std::vector<int> faces_by_vertices(const InspectedMesh& s, const std::vector<int>& sorted) {
  const auto& start = s.mesh.face_start;
  const auto smallest = [&](int f) { return s.well_formed(f) ? sorted[start[f]] : -1; };
  Groups faces = group_by(s.mesh.face_count(), s.mesh.vertex_count(), smallest);
  const auto before = [&](int f, int g) {
    const auto order =
        std::lexicographical_compare_three_way(sorted.begin() + start[f], sorted.begin() + start[f + 1],
                                               sorted.begin() + start[g], sorted.begin() + start[g + 1]);
    return std::is_eq(order) ? f < g : std::is_lt(order);
  };
  for (int v = 0; v < faces.size(); ++v)
    std::sort(faces.items.begin() + faces.start[v], faces.items.begin() + faces.start[v + 1], before);
  return std::move(faces.items);
}

void report_indices(InspectedMesh& s, Inspection& result) {
  int faces = 0, first = -1;
  for (int c = 0; c < s.corner_count(); ++c) {
    FaceState& state = s.state[s.face_of[c]];
    if (in_range(s.mesh, s.mesh.corners[c]) || state == FaceState::malformed) continue;
    state = FaceState::malformed;
    if (faces++ == 0) first = c;
  }
  if (faces == 0) return;
  add(result, DefectKind::index_out_of_range, faces,
      fmt::format(
          "face {} names vertex {}, but the vertices are numbered from 0 to {}{}; correct or remove the face",
          s.face_of[first], s.mesh.corners[first], result.vertices - 1, such(faces, "faces")));
}

void report_positions(const PolygonMesh& mesh, Inspection& result) {
  int vertices = 0, first = -1;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.V.row(v).allFinite()) continue;
    if (vertices++ == 0) first = v;
  }
  if (vertices == 0) return;
  const auto p = mesh.V.row(first);
  add(result, DefectKind::non_finite_position, vertices,
      fmt::format("vertex {} is at ({}, {}, {}){}; give it finite coordinates", first, p[0], p[1], p[2],
                  such(vertices, "vertices")));
}

// Doubles must be able to hold squared lengths.
void report_size(const PolygonMesh& mesh, Inspection& result) {
  if (has(result, DefectKind::non_finite_position)) return;
  int vertices = 0, first = -1;
  for (int v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.V.row(v).cwiseAbs().maxCoeff() <= largest_coordinate) continue;
    if (vertices++ == 0) first = v;
  }
  if (vertices > 0) {
    const auto p = mesh.V.row(first);
    add(result, DefectKind::size_out_of_range, vertices,
        fmt::format(
            "vertex {} is at ({}, {}, {}){}, too far out to compute with in double precision; scale the "
            "mesh down",
            first, p[0], p[1], p[2], such(vertices, "vertices")));
    return;
  }
  const double size = (mesh.V.colwise().maxCoeff() - mesh.V.colwise().minCoeff()).maxCoeff();
  if (size == 0 || size >= smallest_size) return;
  add(result, DefectKind::size_out_of_range, 1,
      fmt::format("the mesh is only {:.3g} wide, too small to compute with in double precision; scale it up",
                  size));
}

void report_corner_counts(InspectedMesh& s, Inspection& result) {
  int faces = 0, first = -1;
  for (int f = 0; f < result.faces; ++f) {
    if (s.mesh.face_degree(f) >= 3) continue;
    s.state[f] = FaceState::malformed;
    if (faces++ == 0) first = f;
  }
  if (faces == 0) return;
  const int degree = s.mesh.face_degree(first);
  add(result, DefectKind::too_few_corners, faces,
      fmt::format("face {} has {} corner{}{}; remove it, since a face needs three", first,
                  degree == 0 ? "no" : std::to_string(degree), degree == 1 ? "" : "s", such(faces, "faces")));
}

void report_repeated_vertices(InspectedMesh& s, const std::vector<int>& sorted, Inspection& result) {
  int faces = 0, first = -1, vertex = -1;
  for (int f = 0; f < result.faces; ++f) {
    const auto end = sorted.begin() + s.mesh.face_start[f + 1];
    const auto repeated = std::adjacent_find(sorted.begin() + s.mesh.face_start[f], end);
    if (repeated == end || s.mesh.face_degree(f) < 3) continue;
    s.state[f] = FaceState::malformed;
    if (faces++ == 0) first = f, vertex = *repeated;
  }
  if (faces == 0) return;
  add(result, DefectKind::repeated_vertex, faces,
      fmt::format("face {} names vertex {} more than once{}; correct the face or remove it", first, vertex,
                  such(faces, "faces")));
}

void report_duplicates(InspectedMesh& s, const std::vector<int>& sorted, Inspection& result) {
  const std::vector<int> originals = first_doubles(s, sorted);
  int duplicates = 0;
  std::pair<int, int> first = {result.faces, result.faces};
  for (int f = 0; f < result.faces; ++f) {
    const int original = originals[f];
    if (original < 0 || original == f) continue;
    s.state[f] = FaceState::duplicate;
    s.has_double[original] = s.has_double[f] = 1;
    first = std::min(first, {original, f});
    ++duplicates;
  }
  if (duplicates == 0) return;
  add(result, DefectKind::duplicate_face, duplicates,
      fmt::format("faces {} and {} have the same vertices{}; remove one of them", first.first, first.second,
                  such(duplicates, "faces")));
}

}  // namespace

std::vector<int> sorted_corners(const PolygonMesh& mesh) {
  std::vector<int> corners = mesh.corners;
  for (int f = 0; f < mesh.face_count(); ++f)
    std::sort(corners.begin() + mesh.face_start[f], corners.begin() + mesh.face_start[f + 1]);
  return corners;
}

std::vector<int> first_doubles(const InspectedMesh& s, const std::vector<int>& sorted) {
  const auto& start = s.mesh.face_start;
  const auto same = [&](int f, int g) {
    return std::equal(sorted.begin() + start[f], sorted.begin() + start[f + 1], sorted.begin() + start[g],
                      sorted.begin() + start[g + 1]);
  };
  std::vector<int> originals(s.mesh.face_count(), -1);
  int original = -1;
  for (const int f : faces_by_vertices(s, sorted)) {
    if (original < 0 || !same(original, f)) original = f;
    originals[f] = original;
  }
  return originals;
}

void inspect_faces(InspectedMesh& inspected, Inspection& result) {
  const std::vector<int> sorted = sorted_corners(inspected.mesh);
  report_indices(inspected, result);
  report_positions(inspected.mesh, result);
  report_size(inspected.mesh, result);
  report_corner_counts(inspected, result);
  report_repeated_vertices(inspected, sorted, result);
  report_duplicates(inspected, sorted, result);
}

}  // namespace orbitutte::inspection
