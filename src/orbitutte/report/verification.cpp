// SPDX-License-Identifier: MIT
#include "orbitutte/report/verification.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <utility>

#include "orbitutte/mesh/intrinsic_triangulation.h"
#include "orbitutte/orbifold/precise_group.h"
#include "orbitutte/orbifold/signature.h"
#include "orbitutte/quotient/quotient.h"
#include "orbitutte/verify/energy.h"
#include "orbitutte/weights/cone_weights.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

Check claim(std::string name, bool holds, std::string detail) {
  return {std::move(name), holds, holds ? 0.0 : 1.0, 0, holds ? std::string() : std::move(detail)};
}

// The weights that the embedding was computed with; nothing if they came from a file that is not at hand.
std::optional<EdgeWeights> weights_at_hand(const Surface& surface, const Embedding& embedding,
                                           const Report& report, const VerificationOptions& options) {
  if (options.weights) return options.weights;
  if (report.weights.kind != WeightKind::file) {
    if (!options.weights_file.empty())
      throw ArgumentError(fmt::format(
          "the weights of this embedding are {}, which need no file; leave out the file of weights",
          name_of(report.weights.kind)));
    return weights_of(surface, embedding, report);
  }
  if (options.weights_file.empty()) return std::nullopt;
  return read_weights(options.weights_file, surface.connectivity);
}

// E as the report says, from the mesh and the positions.
Check energy_check(double energy, const Report& report) {
  const double difference = std::abs(energy - report.energy);
  Check check = {"energy", difference <= 1e-9 * std::abs(energy), difference, 1e-9 * std::abs(energy), {}};
  if (!check.passed)
    check.detail = fmt::format("the energy is {:.12g}, the report says {:.12g}", energy, report.energy);
  return check;
}

bool has_passed(const Certificate& certificate, const char* name) {
  return std::any_of(certificate.checks.begin(), certificate.checks.end(),
                     [&](const Check& check) { return check.name == name && check.passed; });
}

// Is the embedding sound enough to speak of its cover?
bool has_cover(const Certificate& certificate) {
  const auto checks = {"cut_mesh", "unit_positions", "seam_transforms", "seam_gluing", "group_order"};
  return std::all_of(checks.begin(), checks.end(),
                     [&](const char* name) { return has_passed(certificate, name); });
}

Theorem2 not_run(std::string reason) {
  Theorem2 theorem2;
  theorem2.detail = std::move(reason);
  return theorem2;
}

Theorem2 theorem2_of(const Surface& surface, const std::optional<EdgeWeights>& weights,
                     const Embedding& embedding, const Certificate& certificate) {
  if (std::string reason = reason_without_theorem2(embedding.target); !reason.empty())
    return not_run(std::move(reason));
  if (!has_cover(certificate)) return not_run("the copies of the embedding do not fit together");
  if (!weights) return not_run("the weights came from a file: give it with --weights-file");
  return check_theorem2(surface, *weights, embedding);
}

// Is the map no minimum of the energy, of which the theorem speaks?
bool is_no_minimum(const Report& report) { return report.quotient || !report.moved_vertices.empty(); }

const char* reason_for_no_minimum(const Report& report) {
  return report.quotient ? "the map is the quotient of a minimum of the energy, and none itself"
                         : "vertices were moved off the minimum of the energy, of which the theorem "
                           "speaks (moved_vertices in the report)";
}

// What the report says of the triangulation that has the weights.
Check intrinsic_claim(const Surface& surface, const Embedding& embedding, const EdgeWeights& weights,
                      const Report& report) {
  const bool bijective =
      weights.triangulation && certify_intrinsic(surface, embedding, *weights.triangulation).bijective;
  return claim("report_intrinsic_bijective", *report.intrinsic_bijective == (bijective && report.converged),
               fmt::format("the report says bijective = {} of the intrinsic triangulation",
                           *report.intrinsic_bijective));
}

// The seams' transforms are elements of the target's group where the report says that the map lies.
Check placement_claim(const Embedding& embedding, const Isometry& placement) {
  const char* const check = "report_placement";
  const PreciseGroup<double> group(embedding.target);
  for (std::size_t s = 0; s < embedding.seams.size(); ++s) {
    try {
      group.element(placement.inverse() * embedding.seams[s].transform * placement);
    } catch (const ArgumentError& error) {
      return claim(
          check, false,
          fmt::format("the transform of seam {} does not fit the report's placement: {}", s, error.what()));
    }
  }
  return claim(check, true, {});
}

// Moved vertices are vertices of the surface.
Check moved_vertices_claim(const Surface& surface, const Report& report) {
  const auto is_none = [&](int v) { return v < 0 || v >= surface.vertex_count(); };
  const auto first = std::find_if(report.moved_vertices.begin(), report.moved_vertices.end(), is_none);
  const bool holds = first == report.moved_vertices.end();
  return claim("report_moved_vertices", holds,
               holds ? std::string()
                     : fmt::format("the report says that vertex {} was moved, but there are {}", *first,
                                   surface.vertex_count()));
}

// The centre of mass is where the report says, and vertices lie at the points that it names.
std::vector<Check> quotient_claims(const Surface& surface, const Embedding& embedding,
                                   const QuotientRecord& quotient) {
  constexpr double bound = 1e-9;
  std::vector<Check> checks;
  const auto at_most = [&](const char* name, double value, const char* what) {
    Check check = {name, value <= bound, value, bound, {}};
    if (!check.passed) check.detail = fmt::format("{} by {:.3g}", what, value);
    checks.push_back(std::move(check));
  };
  const bool has_centre = quotient.centre == Centre::area || quotient.centre == Centre::vertices;
  if (has_centre && quotient.points.size() < 2)
    at_most("report_centre", distance_from_centre(surface, quotient.centre, embedding),
            "the centre of mass is off the centre of the sphere");
  const Points positions = embedding.canonical_positions();
  for (const PolygonCorner& at : quotient.points) {
    const bool is_vertex = at.vertex >= 0 && at.vertex < surface.vertex_count();
    at_most("report_points", is_vertex ? (Vector3(positions.row(at.vertex)) - at.position).norm() : 2.0,
            "a vertex is off the point that the report names");
  }
  return checks;
}

std::vector<Check> check_claims(const Certificate& certificate, const Report& report) {
  return {claim("report_bijective", report.bijective == (certificate.bijective && report.converged),
                fmt::format("the report says bijective = {}", report.bijective)),
          claim("report_expected_area", std::abs(report.expected_area - certificate.expected_area) <= 1e-9,
                fmt::format("the report expects the area {:.12g}, it is {:.12g}", report.expected_area,
                            certificate.expected_area)),
          claim("report_nonpositive_faces", report.nonpositive_faces == certificate.nonpositive_faces,
                fmt::format("the report names {} nonpositive faces, there are {}",
                            report.nonpositive_faces.size(), certificate.nonpositive_faces.size()))};
}

Json to_json(const std::vector<Check>& checks) {
  Json rows = Json::array();
  for (const Check& check : checks)
    rows.push_back({{"name", check.name},
                    {"passed", check.passed},
                    {"value", check.value},
                    {"bound", check.bound},
                    {"detail", check.detail}});
  return rows;
}

Json to_json(const RepresentationInertia& part) {
  return {{"dimension", part.dimension}, {"multiplicity", part.multiplicity},
          {"unknowns", part.unknowns},   {"negative", part.negative},
          {"kernel", part.kernel},       {"coordinates", part.coordinates},
          {"shift", part.shift}};
}

Json to_json(const Theorem2& theorem2) {
  Json representations = Json::array();
  for (const RepresentationInertia& part : theorem2.representations) representations.push_back(to_json(part));
  const bool measured = theorem2.status == Theorem2::Status::measured;
  return {{"status", name_of(theorem2.status)},
          {"holds", theorem2.holds()},
          {"detail", theorem2.detail},
          {"method", name_of(theorem2.method)},
          {"max_edge_length", theorem2.max_edge_length},
          {"negative_eigenvalues", measured ? Json(theorem2.negative) : Json()},
          {"kernel_dimension", measured ? Json(theorem2.kernel) : Json()},
          {"kernel_residual", theorem2.kernel_residual},
          {"checks", to_json(theorem2.checks())},
          {"representations", representations}};
}

}  // namespace

Verdict verify(const Surface& surface, const Embedding& embedding, const Report& report,
               const VerificationOptions& options) {
  const Certificate certificate = certify(surface, embedding);
  std::optional<EdgeWeights> weights;  // of an embedding of this surface
  if (has_passed(certificate, "cut_mesh")) weights = weights_at_hand(surface, embedding, report, options);
  Verdict verdict;
  verdict.checks = certificate.checks;
  for (Check& check : check_claims(certificate, report)) verdict.checks.push_back(std::move(check));
  if (report.placement && has_passed(certificate, "cones") && !embedding.target.has_free_tile)
    verdict.checks.push_back(placement_claim(embedding, *report.placement));
  if (report.quotient && has_passed(certificate, "cut_mesh") && embedding.target.marks.empty())
    for (Check& check : quotient_claims(surface, embedding, *report.quotient))
      verdict.checks.push_back(std::move(check));
  if (!report.moved_vertices.empty()) verdict.checks.push_back(moved_vertices_claim(surface, report));
  if (certificate.bijective && weights)
    verdict.checks.push_back(energy_check(dirichlet_energy(surface, *weights, embedding), report));
  if (report.intrinsic_bijective && weights)
    verdict.checks.push_back(intrinsic_claim(surface, embedding, *weights, report));
  verdict.sound = certificate.bijective;
  for (const Check& check : verdict.checks) verdict.sound = verdict.sound && check.passed;
  verdict.converged = report.converged;
  verdict.bijective = verdict.sound && report.converged;
  if (options.theorem2)
    verdict.theorem2 = is_no_minimum(report) ? not_run(reason_for_no_minimum(report))
                                             : theorem2_of(surface, weights, embedding, certificate);
  return verdict;
}

std::string verdict_json(const Verdict& verdict) {
  Json json = {{"bijective", verdict.bijective}, {"checks", to_json(verdict.checks)}};
  if (verdict.theorem2) json["theorem2"] = to_json(*verdict.theorem2);
  return json.dump(1) + "\n";
}

EdgeWeights weights_of(const Surface& surface, const Embedding& embedding, const Report& report) {
  std::vector<Mark> marks;
  for (const ConeCopies& cone : embedding.cones) marks.push_back(cone.mark);
  const std::vector<double> angles = metric_angles(marks);
  std::vector<ConeAngle> cones;
  for (std::size_t k = 0; k < angles.size(); ++k)
    if (angles[k] > 0) cones.push_back({embedding.cones[k].vertex, angles[k]});
  UnflippedEdges unflipped = {report.kept_faces};
  if (are_opposite(marks))
    unflipped.kept_apart.push_back({embedding.cones[0].vertex, embedding.cones[1].vertex});
  const EdgeWeights weights = edge_weights(surface, report.weights, {report.kept_faces});
  return sharpened_at_cones(kept_apart(weights, surface, report.weights, unflipped), cones,
                            unflipped.kept_apart);
}

}  // namespace orbitutte
