// SPDX-License-Identifier: MIT
#include "orbitutte/export/closed_mesh.h"

#include <fmt/format.h>

#include "orbitutte/inspect/inspection.h"
#include "orbitutte/inspect/recognition.h"
#include "orbitutte/orbifold/target_words.h"

namespace orbitutte {
namespace {

std::string fault_of(const Inspection& found) {
  if (!found.defects.empty()) return found.defects.front().message;
  if (found.unreferenced_vertices > 0) return "a vertex is in no face";
  return fmt::format("the surface is a {}", text_of(found.topology));
}

void require_closed_sphere(const Inspection& found) {
  if (found.defects.empty() && found.topology == Topology::sphere && found.unreferenced_vertices == 0) return;
  throw MeshError(
      fmt::format("the copies of the embedding do not make up one closed mesh (in the numbers of the tiling: "
                  "{}); mend the "
                  "mesh there, as 'orbitutte info' says, and embed it again",
                  fault_of(found)));
}

}  // namespace

void require_closed_sphere(const Mesh& mesh) {
  if (!is_sound_sphere(mesh)) require_closed_sphere(inspect(mesh));
}

void require_closed_sphere(const Points& V, const Polygons& polygons) {
  require_closed_sphere(inspect(PolygonMesh{V, polygons.corners, polygons.start}));
}

}  // namespace orbitutte
