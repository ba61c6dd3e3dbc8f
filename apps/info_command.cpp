// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <numbers>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/orbifold/target_words.h"
#include "orbitutte/report/inspection_json.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

constexpr int sound = 0, defective = 3;

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

void print_text(const std::string& path, const Inspection& inspection, const std::vector<WeakPlace>& places) {
  fmt::print("{}: {}\n", path, inspection.defects.empty() ? text_of(inspection.topology) : "defective");
  fmt::print("  vertices {} ({} in no face), edges {}, faces {} ({} triangles, up to {} corners)\n",
             inspection.vertices, inspection.unreferenced_vertices, inspection.edges, inspection.faces,
             inspection.triangles, inspection.max_face_degree);
  fmt::print("  components {}, Euler characteristic {}, genus {}, boundary curves {}\n",
             inspection.components, inspection.euler_characteristic, inspection.genus,
             inspection.boundary.size());
  for (const std::vector<int>& loop : inspection.boundary)
    fmt::print("    boundary of {} edges through vertex {}\n", loop.size(), loop.front());
  if (inspection.area > 0)
    fmt::print("  angles {:.3g} to {:.3g} degrees, edges {:.4g} to {:.4g}, zero-area faces {}\n",
               degrees(inspection.min_angle), degrees(inspection.max_angle), inspection.min_edge_length,
               inspection.max_edge_length, inspection.zero_area_faces);
  if (inspection.triangles > 0)
    fmt::print("  cotangent weights: {} negative, {} zero\n", inspection.negative_cotangent_edges,
               inspection.zero_cotangent_edges);
  for (const Defect& defect : inspection.defects) fmt::print("  defect: {}\n", defect.message);
  if (!inspection.welding_advice.empty()) fmt::print("  hint: {}\n", inspection.welding_advice);
  for (const WeakPlace& place : places) fmt::print("  not 3-connected: {}\n", place.message);
  if (const std::vector<std::string> into = families_for(inspection); !into.empty()) {
    fmt::print("  embeds into {}\n", fmt::join(into, ", "));
  } else if (inspection.defects.empty()) {
    fmt::print("  embeds into none of the families\n");
  }
}

}  // namespace

int info_command(const InfoArguments& arguments) {
  const PolygonMesh mesh = read_mesh(mesh_input(arguments.mesh, arguments.format));
  const Inspection inspection = inspect(mesh);
  const std::vector<WeakPlace> places = weak_places_if_sound(mesh, inspection);
  for (const std::string& warning : mesh.warnings) tell("orbitutte: warning: {}\n", warning);
  if (arguments.json) {
    fmt::print("{}", inspection_json(arguments.mesh, mesh, inspection, places));
  } else {
    print_text(arguments.mesh, inspection, places);
  }
  return inspection.defects.empty() ? sound : defective;
}

int types_command(const TypesArguments& arguments) {
  if (!arguments.json) {
    fmt::print("{:<8} {:>11}  {:<16} {}\n", "family", "group order", "input", "marked vertices");
    for (const FamilyDescription& family : families())
      fmt::print("{:<8} {:>11}  {:<16} {}\n", family.family, family.group_order, name_of(family.topology),
                 family.marked_points);
    fmt::print("N is 2 or more, in Nx also 1. Commas separate orders of two digits: 2,2,12.\n");
    fmt::print("'sphere' and 'hemisphere' are other words for 1 and *.\n");
    fmt::print(
        "Larger or more orders, such as 7,3,2, 2,2,2,2,2 or *2,2,2,2,2, are hyperbolic: spheres, or disks "
        "behind a star.\n");
    fmt::print("'cones' and '*cones' in place of a symbol: cones and corners of any angles (--angles).\n");
    fmt::print(
        "'polygon' in place of a symbol: a disk onto a convex spherical polygon that holds its boundary.\n");
    return 0;
  }
  fmt::print("{}", families_json());
  return 0;
}

}  // namespace orbitutte::cli
