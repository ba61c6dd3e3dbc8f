// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <numbers>

#include "commands.h"
#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/mesh_io.h"
#include "orbitutte/mesh/weak_places.h"
#include "orbitutte/orbifold/signature.h"

namespace orbitutte::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int sound = 0, defective = 3;

std::vector<std::string> targets(const Inspection& inspection) {
  std::vector<std::string> result;
  for (const FamilyDescription& family : families())
    if (family.topology == inspection.topology) result.push_back(family.family);
  return result;
}

double degrees(double radians) { return radians * 180 / std::numbers::pi; }

std::vector<WeakPlace> weak_places(const PolygonMesh& mesh, const Inspection& inspection) {
  return inspection.defects.empty() ? find_weak_places(mesh) : std::vector<WeakPlace>();
}

Json to_json(const std::vector<WeakPlace>& places) {
  Json rows = Json::array();
  for (const WeakPlace& place : places)
    rows.push_back({{"kind", name(place.kind)}, {"count", place.count}, {"message", place.message}});
  return rows;
}

Json to_json(const std::string& path, const Inspection& inspection) {
  Json loops = Json::array(), defects = Json::array();
  for (const std::vector<int>& loop : inspection.boundary)
    loops.push_back({{"vertices", loop.size()}, {"first", loop.front()}});
  for (const Defect& defect : inspection.defects)
    defects.push_back({{"kind", name(defect.kind)}, {"count", defect.count}, {"message", defect.message}});
  return {{"path", path},
          {"topology", name(inspection.topology)},
          {"vertices", inspection.vertices},
          {"unreferenced_vertices", inspection.unreferenced_vertices},
          {"edges", inspection.edges},
          {"faces", inspection.faces},
          {"triangles", inspection.triangles},
          {"max_face_degree", inspection.max_face_degree},
          {"components", inspection.components},
          {"euler_characteristic", inspection.euler_characteristic},
          {"genus", inspection.genus},
          {"orientable", inspection.orientable},
          {"boundary", loops},
          {"zero_area_faces", inspection.zero_area_faces},
          {"area", inspection.area},
          {"min_angle", inspection.min_angle},
          {"max_angle", inspection.max_angle},
          {"min_edge_length", inspection.min_edge_length},
          {"max_edge_length", inspection.max_edge_length},
          {"negative_cotangent_edges", inspection.negative_cotangent_edges},
          {"zero_cotangent_edges", inspection.zero_cotangent_edges},
          {"defects", defects},
          {"embeds_into", targets(inspection)}};
}

void print_text(const std::string& path, const Inspection& inspection, const std::vector<WeakPlace>& places) {
  fmt::print("{}: {}\n", path, inspection.defects.empty() ? name(inspection.topology) : "defective");
  fmt::print("  vertices {} ({} in no face), edges {}, faces {} ({} triangles, up to {} corners)\n",
             inspection.vertices, inspection.unreferenced_vertices, inspection.edges, inspection.faces,
             inspection.triangles, inspection.max_face_degree);
  fmt::print("  components {}, Euler characteristic {}, genus {}, boundary curves {}\n",
             inspection.components, inspection.euler_characteristic, inspection.genus,
             inspection.boundary.size());
  for (const std::vector<int>& loop : inspection.boundary)
    fmt::print("    boundary of {} edges through vertex {}\n", loop.size(), loop.front());
  if (inspection.triangles > 0)
    fmt::print("  angles {:.3g} to {:.3g} degrees, edges {:.4g} to {:.4g}, zero-area faces {}\n",
               degrees(inspection.min_angle), degrees(inspection.max_angle), inspection.min_edge_length,
               inspection.max_edge_length, inspection.zero_area_faces);
  fmt::print("  cotangent weights: {} negative, {} zero\n", inspection.negative_cotangent_edges,
             inspection.zero_cotangent_edges);
  for (const Defect& defect : inspection.defects) fmt::print("  defect: {}\n", defect.message);
  for (const WeakPlace& place : places) fmt::print("  not 3-connected: {}\n", place.message);
  if (const std::vector<std::string> into = targets(inspection); !into.empty()) {
    fmt::print("  embeds into {}\n", fmt::join(into, ", "));
  } else if (inspection.defects.empty()) {
    fmt::print("  embeds into none of the families there are yet\n");
  }
}

}  // namespace

int info_command(const InfoArguments& arguments) {
  const PolygonMesh mesh = read_mesh(arguments.mesh);
  const Inspection inspection = inspect(mesh);
  const std::vector<WeakPlace> places = weak_places(mesh, inspection);
  if (arguments.json) {
    Json json = to_json(arguments.mesh, inspection);
    json["weak_places"] = to_json(places);
    fmt::print("{}\n", json.dump(1));
  } else {
    print_text(arguments.mesh, inspection, places);
  }
  return inspection.defects.empty() ? sound : defective;
}

int types_command(bool json) {
  if (!json) {
    fmt::print("{:<8} {:>11}  {:<8} {}\n", "family", "group order", "input", "marked points");
    for (const FamilyDescription& family : families())
      fmt::print("{:<8} {:>11}  {:<8} {}\n", family.family, family.group_order, name(family.topology),
                 family.marked_points);
    fmt::print("N is any order of 2 or more. Orders of two digits are separated by commas: 2,2,12.\n");
    fmt::print(
        "Besides, 'polygon': a disk onto a convex spherical polygon, its boundary fixed (--polygon).\n");
    return 0;
  }
  Json rows = Json::array();
  for (const FamilyDescription& family : families())
    rows.push_back({{"family", family.family},
                    {"group_order", family.group_order},
                    {"input", name(family.topology)},
                    {"marked_points", family.marked_points}});
  fmt::print("{}\n", rows.dump(1));
  return 0;
}

}  // namespace orbitutte::cli
