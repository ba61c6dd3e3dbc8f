// SPDX-License-Identifier: MIT
// Embeddings of one mesh into several orbifolds side by side (section 6.3).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <nlohmann/json.hpp>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/choose.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/report/comparison.h"
#include "orbitutte/report/report.h"
#include "page_pictures.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Compared {
  Target target;
  EmbedResult result;
};

// The symbols that were given; otherwise one of the sphere and one of the plane.
std::vector<std::string> symbols_or_both_spaces(const std::vector<std::string>& given, Topology topology) {
  if (!given.empty()) return given;
  const std::string star = topology == Topology::disk ? "*" : "";
  return {star + "432", star + "442"};
}

void print_row(const Compared& compared) {
  const Distortion& d = compared.result.distortion;
  fmt::print("{:<10} {:<10} {:>9.4g} {:>9.4g} {:>9.4g} {:>10.4g} {:>9.4g} {:>9.4g}  {}\n",
             compared.target.space.name(), compared.target.signature, d.area.mean, d.area.std, d.area.median,
             d.area.max, d.angle.mean, d.angle.max, compared.result.certificate.bijective ? "yes" : "no");
}

Json to_json(const Compared& compared) {
  Json row = {{"orbifold", compared.target.signature},
              {"space", compared.target.space.name()},
              {"energy", compared.result.minimum.energy},
              {"bijective", compared.result.certificate.bijective}};
  row.update(Json::parse(distortion_json(compared.result.distortion)));
  return row;
}

ComparedMap compared_map(const Surface& surface, const Compared& compared) {
  const std::string verdict = compared.result.certificate.bijective ? "" : " (not certified)";
  return {compared.target.space.name() + ": " + compared.target.signature + verdict,
          compared.result.distortion.area, measure_triangles(surface, compared.result.embedding)};
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
  const Surface surface = make_surface(read_mesh(mesh_input(arguments.mesh, arguments.format)));
  const Viewpoint viewpoint = parse_viewpoint(arguments.view, arguments.up, surface);
  EmbedOptions options;
  options.weights.kind = parse_choice<WeightKind>(arguments.weights, "--weights");

  std::vector<Compared> maps;
  std::vector<ComparedMap> pictures;
  std::vector<int> cones;
  if (arguments.cones != "auto" && cones_word(arguments.cones) != ConesWord::extremities)
    cones = parse_cones(arguments.cones);
  if (std::count(cones.begin(), cones.end(), best_vertex) > 0)
    throw ArgumentError("--cones are the same for all that is compared; give vertices, or 'extremities'");
  for (const std::string& symbol : symbols_or_both_spaces(arguments.orbifolds, surface.topology)) {
    const Target target = parse_orbifold(symbol);
    if (cones.empty()) cones = choose_cones(surface, target);
    maps.push_back({target, embed(surface, target, cones, options)});
    pictures.push_back(compared_map(surface, maps.back()));
  }
  if (arguments.json) {
    Json rows = Json::array();
    for (const Compared& compared : maps) rows.push_back(to_json(compared));
    fmt::print("{}\n", Json({{"mesh", arguments.mesh}, {"cones", cones}, {"maps", rows}}).dump(1));
  } else {
    fmt::print("{}: {} faces, cones {}\n", arguments.mesh, surface.faces().count(), fmt::join(cones, ","));
    fmt::print("{:<10} {:<10} {:>9} {:>9} {:>9} {:>10} {:>9} {:>9}  {}\n", "", "orbifold", "area mean", "std",
               "median", "max", "angle", "max", "certified");
    for (const Compared& compared : maps) print_row(compared);
    tell("1 is no distortion of areas or angles\n");
  }
  if (!arguments.output.empty())
    write_comparison(arguments.output, {surface, cones, std::move(pictures), viewpoint.view, viewpoint.up});
  const bool certified = std::all_of(maps.begin(), maps.end(), [](const Compared& compared) {
    return compared.result.certificate.bijective;
  });
  return certified ? succeeded : not_certified;
}

}  // namespace orbitutte::cli
