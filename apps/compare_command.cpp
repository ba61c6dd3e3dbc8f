// SPDX-License-Identifier: MIT
// Spherical and Euclidean orbifold Tutte embeddings of one mesh side by side (section 6.3).
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <nlohmann/json.hpp>

#include "command_arguments.h"
#include "commands.h"
#include "orbitutte/embed.h"
#include "orbitutte/io/mesh_io.h"
#include "orbitutte/report/comparison.h"

namespace orbitutte::cli {
namespace {

using Json = nlohmann::ordered_json;

struct Compared {
  Orbifold orbifold;
  EmbedResult result;
};

Orbifold orbifold_or(const std::string& given, const std::string& otherwise) {
  return parse_orbifold(given.empty() ? otherwise : given);
}

Orbifold flat_or(const std::string& given, const std::string& otherwise) {
  return parse_euclidean_orbifold(given.empty() ? otherwise : given);
}

void print_row(const Compared& compared) {
  const Distortion& d = compared.result.distortion;
  fmt::print("{:<10} {:<10} {:>9.4g} {:>9.4g} {:>9.4g} {:>10.4g} {:>9.4g} {:>9.4g}  {}\n",
             compared.orbifold.geometry == Geometry::spherical ? "spherical" : "Euclidean",
             compared.orbifold.signature, d.area.mean, d.area.std, d.area.median, d.area.max, d.angle.mean,
             d.angle.max, compared.result.certificate.bijective ? "yes" : "no");
}

Json to_json(const Compared& compared) {
  const Distortion& d = compared.result.distortion;
  return {
      {"orbifold", compared.orbifold.signature},
      {"energy", compared.result.minimum.energy},
      {"bijective", compared.result.certificate.bijective},
      {"area", {{"mean", d.area.mean}, {"std", d.area.std}, {"median", d.area.median}, {"max", d.area.max}}},
      {"angle", {{"mean", d.angle.mean}, {"max", d.angle.max}}}};
}

ComparedMap compared_map(const Surface& surface, const Compared& compared) {
  const bool is_spherical = compared.orbifold.geometry == Geometry::spherical;
  const std::string verdict = compared.result.certificate.bijective ? "" : " (not certified)";
  return {(is_spherical ? "sphere: " : "plane: ") + compared.orbifold.signature + verdict,
          compared.result.distortion.area, measure_faces(surface, compared.result.embedding)};
}

}  // namespace

int compare_command(const CompareArguments& arguments) {
  const Surface surface = make_surface(read_mesh(arguments.mesh));
  const std::string star = surface.topology == Topology::disk ? "*" : "";
  const std::array orbifolds = {orbifold_or(arguments.orbifold, star + "432"),
                                flat_or(arguments.flat, star + "442")};
  EmbedOptions options;
  options.weights.kind = parse_weights(arguments.weights);

  std::vector<Compared> maps;
  std::vector<ComparedMap> pictures;
  std::vector<int> cones;
  if (arguments.cones != "auto") cones = parse_cones(arguments.cones);
  for (const Orbifold& orbifold : orbifolds) {
    if (cones.empty()) cones = choose_marked_vertices(surface, orbifold);
    maps.push_back({orbifold, embed(surface, orbifold, cones, options)});
    pictures.push_back(compared_map(surface, maps.back()));
  }
  if (arguments.json) {
    fmt::print("{}\n", Json({{"mesh", arguments.mesh},
                             {"cones", cones},
                             {"spherical", to_json(maps[0])},
                             {"euclidean", to_json(maps[1])}})
                           .dump(1));
  } else {
    fmt::print("{}: {} triangles, cones {}\n", arguments.mesh, surface.triangles.rows(),
               fmt::join(cones, ","));
    fmt::print("{:<10} {:<10} {:>9} {:>9} {:>9} {:>10} {:>9} {:>9}  {}\n", "", "orbifold", "area mean", "std",
               "median", "max", "angle", "max", "certified");
    for (const Compared& compared : maps) print_row(compared);
  }
  if (!arguments.output.empty()) write_comparison(arguments.output, {surface, cones, std::move(pictures)});
  const bool certified = maps[0].result.certificate.bijective && maps[1].result.certificate.bijective;
  return certified ? succeeded : not_certified;
}

}  // namespace orbitutte::cli
