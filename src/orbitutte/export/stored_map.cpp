// SPDX-License-Identifier: MIT
#include "orbitutte/export/stored_map.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>

#include "orbitutte/errors.h"
#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/io/file.h"
#include "orbitutte/report/report.h"
#include "orbitutte/verify/certificate.h"

namespace orbitutte {
namespace {

// An embedding in a folder, as far as its files tell.
EmbedResult read_side(const std::filesystem::path& folder, const std::string& name, const Surface& surface) {
  const Report report = read_report((folder / fmt::format("{}.json", name)).string());
  EmbedResult result;
  result.embedding = read_embedding((folder / fmt::format("{}.ply", name)).string(), report);
  try {
    require_cut_from(surface, result.embedding);
  } catch (const MeshError&) {
    throw MeshError(fmt::format(
        "{} holds the map of another surface than this {}; give both surfaces as they were mapped, "
        "in the same order",
        folder.string(), name == "a" ? "A" : "B"));
  }
  if (surface.has_polygons() && result.embedding.polygons.start == surface.polygons.start)
    result.embedding.triangles = cut_triangles(surface, result.embedding);
  result.certificate = certify(surface, result.embedding);
  result.minimum.energy = report.energy;
  result.minimum.history = report.history;
  result.minimum.termination = report.converged ? Termination::converged : Termination::max_iterations;
  result.topology = surface.topology;
  return result;
}

// The landmarks and the tile of map.json.
void read_map_json(const std::string& path, SurfaceMap& map) {
  const std::string text = read_file(path);
  try {
    const nlohmann::json json = nlohmann::json::parse(text);
    for (const nlohmann::json& row : json.at("landmarks"))
      map.landmarks.push_back({row.at(0).get<int>(), row.at(1).get<int>()});
    const std::string tile = json.at("target").at("tile").get<std::string>();
    if (tile == name_of(TileShape::regular)) map.map_class.tile = TileShape::regular;
  } catch (const nlohmann::json::exception&) {
    throw MeshError(fmt::format("{}: this is no map.json as 'orbitutte map' writes it", path));
  }
}

void require_landmarks(const SurfaceMap& map, const Surface& a, const Surface& b) {
  for (const Landmark& landmark : map.landmarks)
    if (landmark.a < 0 || landmark.a >= a.vertex_count() || landmark.b < 0 || landmark.b >= b.vertex_count())
      throw MeshError(fmt::format("the map has the landmark {}:{}, which the surfaces do not have",
                                  landmark.a, landmark.b));
}

}  // namespace

SurfaceMap read_surface_map(const std::string& folder, const Surface& a, const Surface& b) {
  SurfaceMap map;
  map.a = read_side(folder, "a", a);
  map.b = read_side(folder, "b", b);
  read_map_json((std::filesystem::path(folder) / "map.json").string(), map);
  require_landmarks(map, a, b);
  return map;
}

}  // namespace orbitutte
