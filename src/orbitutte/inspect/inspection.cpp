// SPDX-License-Identifier: MIT
#include "orbitutte/inspect/inspection.h"

#include <fmt/format.h>

#include "orbitutte/inspect/inspection_steps.h"

namespace orbitutte {
namespace inspection {

constexpr std::size_t most_listed = 5;  // so many elements a sentence names

void add(Inspection& result, DefectKind kind, long long count, std::string message) {
  result.defects.push_back({kind, std::move(message), count});
}

bool has(const Inspection& result, DefectKind kind) {
  return std::any_of(result.defects.begin(), result.defects.end(),
                     [kind](const Defect& defect) { return defect.kind == kind; });
}

std::string such(long long count, const char* plural) {
  return count > 1 ? fmt::format(" ({} such {})", count, plural) : std::string();
}

std::string listed(const std::vector<int>& numbers) {
  const std::size_t n = numbers.size(), named = n > most_listed ? most_listed : n - 1;
  std::string result;
  for (std::size_t i = 0; i < named; ++i) result += (i > 0 ? ", " : "") + std::to_string(numbers[i]);
  if (n > most_listed) return fmt::format("{} and {} more", result, n - most_listed);
  return result + (n > 1 ? " and " : "") + std::to_string(numbers.back());
}

}  // namespace inspection

namespace {

using inspection::in_range;

void require_ascending_offsets(const PolygonMesh& mesh) {
  const auto& start = mesh.face_start;
  const bool sound = !start.empty() && start.front() == 0 && std::is_sorted(start.begin(), start.end()) &&
                     static_cast<std::size_t>(start.back()) == mesh.corners.size();
  if (!sound) throw ArgumentError("face_start must ascend from 0 to the number of corners");
}

void count_elements(const PolygonMesh& mesh, Inspection& result) {
  result.vertices = mesh.vertex_count();
  result.faces = mesh.face_count();
  for (int f = 0; f < mesh.face_count(); ++f) {
    result.triangles += mesh.face_degree(f) == 3;
    result.max_face_degree = std::max(result.max_face_degree, mesh.face_degree(f));
  }
  std::vector<char> referenced(mesh.vertex_count(), 0);
  for (const int v : mesh.corners) {
    if (in_range(mesh, v)) referenced[v] = 1;
  }
  result.unreferenced_vertices = static_cast<int>(std::count(referenced.begin(), referenced.end(), 0));
}

void report_emptiness(Inspection& result) {
  if (result.vertices > 0 && result.faces > 0) return;
  const char* missing = "vertices and no faces";
  if (result.vertices > 0) missing = "faces";
  if (result.faces > 0) missing = "vertices";
  inspection::add(result, DefectKind::empty_mesh, 1,
                  fmt::format("the mesh has no {}; give a mesh that has both", missing));
}

}  // namespace

Inspection inspect(const PolygonMesh& mesh) {
  require_ascending_offsets(mesh);
  Inspection result;
  count_elements(mesh, result);
  report_emptiness(result);
  if (!result.defects.empty()) return result;

  inspection::InspectedMesh inspected(mesh);
  inspect_faces(inspected, result);
  inspect_topology(inspected, result);
  inspect_quality(inspected, result);
  return result;
}

Inspection inspect(const Mesh& mesh) { return inspect(to_polygon_mesh(mesh)); }

void require_embeddable(const Inspection& inspection) {
  if (!inspection.defects.empty()) throw MeshError(inspection.defects.front().message);
}

}  // namespace orbitutte
