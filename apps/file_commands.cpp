// SPDX-License-Identifier: MIT
// verify, tile and sample: from files to files.
#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "commands.h"
#include "orbitutte/mesh/inspection.h"
#include "orbitutte/mesh/mesh_io.h"
#include "orbitutte/mesh/sample.h"
#include "orbitutte/output/report.h"
#include "orbitutte/output/tiling.h"
#include "orbitutte/solve/sparse_factor.h"
#include "orbitutte/verify/energy.h"
#include "orbitutte/version.h"

namespace orbitutte::cli {
namespace {

using Json = nlohmann::ordered_json;

constexpr int accepted = 0, not_converged = 4, rejected = 5;

Check claim(std::string name, bool holds, std::string detail) {
  return {std::move(name), holds, holds ? 0.0 : 1.0, 0, holds ? std::string() : std::move(detail)};
}

// E as the report says, from the mesh and the positions. Weights from a file are not among the three files.
void check_energy(const Mesh& mesh, const Embedding& embedding, const Report& report,
                  std::vector<Check>& checks) {
  if (report.weights.kind == WeightKind::file) return;
  const double energy = dirichlet_energy(mesh, report.weights, embedding);
  const double difference = std::abs(energy - report.energy);
  Check check = {"energy", difference <= 1e-9 * std::abs(energy), difference, 1e-9 * std::abs(energy), {}};
  if (!check.passed)
    check.detail = fmt::format("the energy is {:.12g}, the report says {:.12g}", energy, report.energy);
  checks.push_back(check);
}

// What the report says of the triangulation that has the weights.
void check_intrinsic_claim(const Mesh& mesh, const Embedding& embedding, const Report& report,
                           std::vector<Check>& checks) {
  const EdgeWeights weights = weights_of(mesh, report.weights, embedding);
  const bool bijective =
      weights.triangulation && certify_intrinsic(mesh, embedding, *weights.triangulation).bijective;
  checks.push_back(claim("report_intrinsic_bijective",
                         *report.intrinsic_bijective == (bijective && report.converged),
                         fmt::format("the report says bijective = {} of the intrinsic triangulation",
                                     *report.intrinsic_bijective)));
}

std::vector<Check> check_claims(const Certificate& certificate, const Report& report) {
  return {claim("report_bijective", report.bijective == (certificate.bijective && report.converged),
                fmt::format("the report says bijective = {}", report.bijective)),
          claim("report_nonpositive_faces", report.nonpositive_faces == certificate.nonpositive_faces,
                fmt::format("the report names {} nonpositive faces, there are {}",
                            report.nonpositive_faces.size(), certificate.nonpositive_faces.size()))};
}

void print_checks(const std::vector<Check>& checks, bool bijective, bool json) {
  if (json) {
    Json rows = Json::array();
    for (const Check& check : checks)
      rows.push_back({{"name", check.name},
                      {"passed", check.passed},
                      {"value", check.value},
                      {"bound", check.bound},
                      {"detail", check.detail}});
    fmt::print("{}\n", Json({{"bijective", bijective}, {"checks", rows}}).dump(1));
    return;
  }
  for (const Check& check : checks)
    fmt::print("{} {:<26} {}\n", check.passed ? "ok    " : "FAILED", check.name,
               check.passed ? fmt::format("{:.6g} (bound {:.6g})", check.value, check.bound) : check.detail);
  fmt::print("{}\n", bijective ? "certified: bijective" : "not certified");
}

}  // namespace

int verify_command(const VerifyArguments& arguments) {
  const Report report = read_report(arguments.report);
  const Embedding embedding = read_embedding(arguments.embedding, report);
  PolygonMesh polygons = read_mesh(arguments.mesh);
  require_embeddable(inspect(polygons));
  const Mesh mesh = to_triangle_mesh(std::move(polygons));

  const Certificate certificate = certify(mesh, embedding);
  std::vector<Check> checks = certificate.checks;
  for (Check& check : check_claims(certificate, report)) checks.push_back(std::move(check));
  if (certificate.bijective) check_energy(mesh, embedding, report, checks);
  if (report.intrinsic_bijective) check_intrinsic_claim(mesh, embedding, report, checks);
  bool bijective = certificate.bijective;
  for (const Check& check : checks) bijective = bijective && check.passed;
  print_checks(checks, bijective && report.converged, arguments.json);
  if (!bijective) return rejected;
  return report.converged ? accepted : not_converged;
}

int tile_command(const TileArguments& arguments) {
  const Tiling tiling = tile_sphere(read_embedding(arguments.embedding, read_report(arguments.report)));
  write_tiling(arguments.output, tiling);
  fmt::print(stderr, "{}: {} tiles, {} vertices, {} triangles\n", arguments.output, tiling.tiles,
             tiling.mesh.V.rows(), tiling.mesh.F.rows());
  return accepted;
}

int sample_command(const SampleArguments& arguments) {
  SampleOptions options;
  if (arguments.shape != "figure" && arguments.shape != "mask")
    throw ArgumentError(fmt::format("--shape is '{}'; it may be figure or mask", arguments.shape));
  options.shape = arguments.shape == "figure" ? SampleShape::figure : SampleShape::mask;
  options.faces = arguments.faces;
  const Mesh mesh = sample_mesh(options);
  write_mesh(arguments.output, mesh);
  fmt::print(stderr, "{}: {} vertices, {} triangles\n", arguments.output, mesh.V.rows(), mesh.F.rows());
  return accepted;
}

std::string version_text() {
  const Backend backend = available_backends().front();
  const bool gpl = backend == Backend::cholmod;
  return fmt::format("orbitutte {} ({})\nlinear algebra: {}, BLAS: {}\nlicence: {}", version, commit,
                     name(backend), blas_description(),
                     gpl ? "sources MIT; this binary GPL-2.0-or-later through CHOLMOD's supernodal module"
                         : "MIT (with Eigen, MPL-2.0)");
}

}  // namespace orbitutte::cli
