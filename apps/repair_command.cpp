// SPDX-License-Identifier: MIT
#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/inspect/inspection.h"
#include "orbitutte/inspect/mesh_repair.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/mesh_io.h"
#include "run.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

MeshRepairOptions options_of(const RepairArguments& arguments) {
  MeshRepairOptions options;
  if (arguments.drop_flat) options.without.clear();
  for (const std::string& step : arguments.without)
    options.without.push_back(parse_choice<RepairStep>(step, "--without"));
  options.weld_tolerance = arguments.weld;
  if (arguments.fill_holes && *arguments.fill_holes < 0)
    throw ArgumentError(
        fmt::format("--fill-holes is {}; give a number of edges, 0 for no hole", *arguments.fill_holes));
  if (arguments.fill_holes) options.largest_hole = *arguments.fill_holes;
  return options;
}

nlohmann::ordered_json to_json(const RepairedMesh& repaired, const Inspection& inspection) {
  nlohmann::ordered_json json = {{"vertices", repaired.mesh.vertex_count()},
                                 {"faces", repaired.mesh.face_count()},
                                 {"topology", name_of(inspection.topology)}};
  json["steps"] = nlohmann::ordered_json::array();
  for (const RepairRecord& record : repaired.records)
    json["steps"].push_back(
        {{"step", name_of(record.step)}, {"count", record.count}, {"message", record.message}});
  json["defects"] = nlohmann::ordered_json::array();
  for (const Defect& defect : inspection.defects) json["defects"].push_back(defect.message);
  json["source_vertex"] = repaired.source_vertex;
  return json;
}

}  // namespace

int repair_command(const RepairArguments& arguments) {
  const PolygonMesh mesh = read_mesh(mesh_input(arguments.mesh, arguments.format));
  for (const std::string& warning : mesh.warnings) tell("orbitutte: warning: {}\n", warning);
  const RepairedMesh repaired = repair_mesh(mesh, options_of(arguments));
  if (const auto warning =
          warning_of_lost_faces(arguments.mesh, mesh.face_count(), repaired.mesh.face_count()))
    tell("orbitutte: warning: {}\n", *warning);
  const Inspection inspection = inspect(repaired.mesh);
  write_mesh(arguments.output, repaired.mesh);
  const nlohmann::ordered_json json = to_json(repaired, inspection);
  if (!arguments.report.empty()) write_file(arguments.report, json.dump(1) + "\n");
  if (arguments.json) {
    fmt::print("{}\n", json.dump(1));
  } else {
    tell_steps(repaired.records);
    tell("{}: {} vertices, {} faces, {}\n", arguments.output, repaired.mesh.vertex_count(),
         repaired.mesh.face_count(),
         inspection.defects.empty() ? name_of(inspection.topology) : "still defective");
  }
  for (const Defect& defect : inspection.defects)
    tell("orbitutte: {}: {}\n", arguments.output, defect.message);
  return inspection.defects.empty() ? succeeded : unsuitable_mesh;
}

}  // namespace orbitutte::cli
