// SPDX-License-Identifier: MIT
#include "orbitutte/report/inspection_json.h"

#include <nlohmann/json.hpp>

#include "orbitutte/orbifold/signature.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

Json to_json(const std::vector<WeakPlace>& places) {
  Json rows = Json::array();
  for (const WeakPlace& place : places)
    rows.push_back({{"kind", name_of(place.kind)}, {"count", place.count}, {"message", place.message}});
  return rows;
}

Json to_json(const std::string& path, const Inspection& inspection) {
  Json loops = Json::array(), defects = Json::array();
  for (const std::vector<int>& loop : inspection.boundary)
    loops.push_back({{"vertices", loop.size()}, {"first", loop.front()}});
  for (const Defect& defect : inspection.defects)
    defects.push_back({{"kind", name_of(defect.kind)}, {"count", defect.count}, {"message", defect.message}});
  return {{"path", path},
          {"topology", name_of(inspection.topology)},
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
          {"embeds_into", families_for(inspection)}};
}

}  // namespace

std::vector<std::string> families_for(const Inspection& inspection) {
  std::vector<std::string> result;
  for (const FamilyDescription& family : families())
    if (family.topology == inspection.topology) result.push_back(family.family);
  return result;
}

std::vector<WeakPlace> weak_places_if_sound(const PolygonMesh& mesh, const Inspection& inspection) {
  return inspection.defects.empty() ? find_weak_places(mesh) : std::vector<WeakPlace>();
}

std::string inspection_json(const std::string& path, const PolygonMesh& mesh, const Inspection& inspection,
                            const std::vector<WeakPlace>& places) {
  Json json = to_json(path, inspection);
  json["warnings"] = mesh.warnings;
  json["hints"] = Json::array();
  if (!inspection.welding_advice.empty()) json["hints"].push_back(inspection.welding_advice);
  json["weak_places"] = to_json(places);
  return json.dump(1, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string families_json() {
  Json rows = Json::array();
  for (const FamilyDescription& family : families())
    rows.push_back({{"family", family.family},
                    {"group_order", family.group_order},
                    {"input", name_of(family.topology)},
                    {"marked_vertices", family.marked_points},
                    {"marked_points", family.marked_points}});  // its older name
  return rows.dump(1) + "\n";
}

}  // namespace orbitutte
