// SPDX-License-Identifier: MIT
#include "orbitutte/report/map_report.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "orbitutte/orbifold/polygon.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

Json landmarks_json(const std::vector<Landmark>& landmarks) {
  Json rows = Json::array();
  for (const Landmark& landmark : landmarks) rows.push_back({landmark.a, landmark.b});
  return rows;
}

// E/2A of an embedding: 1 if it is conformal.
double conformality(const EmbedResult& result) {
  return result.minimum.energy / (2 * target_area(result.embedding.target));
}

Json number(double value) { return std::isfinite(value) ? Json(value) : Json(); }

Json target_json(const SurfaceMap& map) {
  const Target& target = map.target();
  return {{"signature", target.signature},
          {"group_order", target.group_order > 0 ? Json(target.group_order) : Json()},
          {"space", target.space.name()},
          {"tile", target.has_free_tile ? Json(name_of(map.map_class.tile)) : Json("fixed")},
          {"conformality", {conformality(map.a), conformality(map.b)}},
          {"class",
           {{"distance", number(map.map_class.distance)},
            {"next_distance", number(map.map_class.next_distance)},
            {"half_twists", map.map_class.half_twists}}}};
}

Json timings_json(const Timings& timings) {
  Json result = Json::object();
  for (const auto& [stage, seconds] : timings)
    result[stage] = (result.contains(stage) ? result[stage].get<double>() : 0.0) + seconds;
  return result;
}

Json overlay_json(const ComposedMap& composed) {
  Json checks = Json::array();
  for (const Check& check : composed.certificate.checks)
    checks.push_back({{"name", check.name},
                      {"passed", check.passed},
                      {"value", number(check.value)},
                      {"bound", number(check.bound)}});
  return {{"vertices", composed.overlay.vertex_count()},
          {"faces", composed.overlay.face_count()},
          {"euler_characteristic", composed.certificate.euler_characteristic},
          {"holds", composed.certificate.holds},
          {"checks", std::move(checks)}};
}

}  // namespace

bool is_certified(const SurfaceMap& map, const std::optional<ComposedMap>& composed) {
  return map.is_bijective() && composed && composed->certificate.holds;
}

std::string map_json(const SurfaceMap& map, const std::optional<ComposedMap>& composed,
                     const Timings& timings) {
  Json json = {
      {"schema", "orbitutte.map/1"},
      {"landmarks", landmarks_json(map.landmarks)},
      {"target", target_json(map)},
      {"bijective", is_certified(map, composed)},
      {"landmark_error", composed ? number(composed->landmark_error) : Json()},
      {"symmetric_dirichlet", composed ? number(composed->distortion.symmetric_dirichlet.mean) : Json()}};
  if (composed) {
    const MapDistortion& distortion = composed->distortion;
    json["distortion"] = {{"median", number(distortion.symmetric_dirichlet.median)},
                          {"percentile_90", number(distortion.symmetric_dirichlet.percentile_90)},
                          {"within_4", distortion.within_4},
                          {"degenerate", distortion.degenerate}};
  }
  json["overlay"] = composed ? overlay_json(*composed) : Json();
  json["warnings"] = map.warnings;
  json["timings"] = timings_json(timings);
  return json.dump(1) + "\n";
}

}  // namespace orbitutte
