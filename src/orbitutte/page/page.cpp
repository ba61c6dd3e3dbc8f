// SPDX-License-Identifier: MIT
#include "orbitutte/page/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/LU>
#include <algorithm>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "orbitutte/export/html_text.h"
#include "orbitutte/export/palette.h"
#include "orbitutte/io/base64.h"
#include "orbitutte/orbifold/polygon.h"
#include "orbitutte/orbifold/symmetry_group.h"
#include "orbitutte/orbifold/target_words.h"
#include "orbitutte/page/html_template.h"
#include "orbitutte/page/page_assets.h"
#include "orbitutte/page/page_frame.h"
#include "orbitutte/page/page_scene.h"
#include "orbitutte/page/svg_chart.h"
#include "orbitutte/report/charts.h"
#include "orbitutte/report/report.h"
#include "orbitutte/verify/certificate.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;

constexpr const char* missing = "–";

// Figures of the report; a dash if one is missing or of another type.

const Json& at(const Json& report, const std::string& path) {
  static const Json nothing;
  const Pointer pointer(path);
  return report.contains(pointer) ? report.at(pointer) : nothing;
}

double number_at(const Json& report, const char* path) {
  const Json& value = at(report, path);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// A value as text: whole numbers with commas, others to six digits.
std::string figure_text(const Json& value) {
  if (value.is_number_integer()) return grouped_digits(value.get<long long>());
  if (value.is_number()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string() && !value.get<std::string>().empty()) return value.get<std::string>();
  return missing;
}

std::string measure_text(double value, const char* unit = "") {
  return std::isfinite(value) ? fmt::format("{:.4g}{}", value, unit) : missing;
}

std::string percent_text(double share) {
  return std::isfinite(share) ? fmt::format("{:.1f} %", 100 * share) : missing;
}

/// The report's figure for a name of the template such as `report.mesh.faces`; nothing for other names.
std::optional<std::string> named_figure(const Json& report, std::string name) {
  if (!name.starts_with("report.")) return std::nullopt;
  std::replace(name.begin(), name.end(), '.', '/');
  return figure_text(at(report, name.substr(name.find('/'))));
}

/// Sections of the template are left out if there is no text.
Content unless_empty(const std::string& text) { return text.empty() ? Content(false) : Content(text); }

// Words

std::string plural(long long count, const std::string& noun) {
  return fmt::format("{} {}{}", grouped_digits(count), noun, count == 1 ? "" : "s");
}

/// What a check of the certificate asks.
std::string check_meaning(const std::string& name) {
  static const std::map<std::string, std::string> meanings = {
      {"cut_mesh", "The embedding has the input's faces and vertices: offences"},
      {"unit_positions", "Positions are points of the target's space: largest error"},
      {"seam_gluing", "Seams pair the whole boundary of one disk, once, if there is any: offences"},
      {"seam_transforms", "Seams are glued by rotations and reflections: offences"},
      {"cones", "Cones and corners are those of the orbifold: offences"},
      {"group_order", "Order of the group that the seams generate"},
      {"seam_residual", "Paired positions match: largest difference"},
      {"positive_faces", "Triangles not positively oriented, by exact signs"},
      {"edge_lengths", "Longest edge, below π"},
      {"convex_faces", "Polygons are convex: faces that are not"},
      {"held_sides", "Boundary vertices lie on the polygon's sides, in order: largest error"},
      {"cone_angles", "Angles at cones and corners: largest error"},
      {"angle_sums", "Angles around all other vertices: largest error"},
      {"offsets", "Offsets are finite and name cut vertices: offences"},
      {"exact_positions",
       "Positions with offsets are such points, too: largest error, in shares of the shortest edge"},
      {"signed_area", "Total area is that of the tile or the polygon: error"}};
  const auto found = meanings.find(name);
  return found == meanings.end() ? name : found->second;
}

struct Judgement {
  Certificate certificate;
  bool converged = false;

  bool bijective() const { return converged && certificate.bijective; }
};

std::string verdict(const Judgement& judgement) {
  if (judgement.bijective()) return "Certified bijective";
  return judgement.converged ? "Not certified" : "Not converged";
}

std::string failed_checks(const Certificate& certificate) {
  std::vector<std::string> names;
  for (const Check& check : certificate.checks)
    if (!check.passed) names.push_back(check.name);
  return fmt::format("{}", fmt::join(names, ", "));
}

// What the copies of the tile cover.
std::string covering(const Target& target) {
  if (target.is_polygon()) return "the map covers the polygon";
  if (!tiles_its_space(target)) return "the tile, glued along its seams, covers the surface with these cones";
  const std::string space = text_of(target.space);
  if (target.group_order == 1) return "the tile covers " + space;
  const std::string count = target.group_order > 0 ? fmt::format("{} ", target.group_order) : "";
  return fmt::format("its {}symmetric copies cover {}", count, space);
}

std::string verdict_sentence(const Judgement& judgement, const Embedding& embedding) {
  if (judgement.bijective())
    return fmt::format(
        "The map is a bijection: {} exactly once, which the certificate below proves on the stored numbers.",
        covering(embedding.target));
  if (judgement.certificate.bijective)
    return "The optimiser stopped before it converged: the map passes every check, but it is not the "
           "minimiser.";
  return "The map is not certified as a bijection; these checks fail: " +
         failed_checks(judgement.certificate) + ".";
}

std::string face_verdict(const Certificate& certificate) {
  const auto folded = static_cast<long long>(certificate.nonpositive_faces.size());
  return folded == 0 ? "Every face is positively oriented"
                     : plural(folded, "face") + " not positively oriented";
}

Content warnings(const Json& report, const Judgement& judgement) {
  Content texts = Content::array();
  const Json& claim = at(report, "/certificate/bijective");
  if (claim.is_boolean() && claim.get<bool>() != judgement.bijective())
    texts.push_back(
        fmt::format("The report says “bijective: {}”, the certificate computed from the files says "
                    "otherwise. This page follows the files.",
                    claim.get<bool>()));
  for (const Json& warning : at(report, "/warnings"))
    if (warning.is_string()) texts.push_back(warning.get<std::string>());
  return texts;
}

// Sections

Content key_figures(const Json& report, const Embedding& embedding) {
  const double conformal = 2 * target_area(embedding.target);
  return {{"angle_median", measure_text(number_at(report, "/distortion/angle/median"))},
          {"angle", measure_text(number_at(report, "/distortion/angle/mean"))},
          {"area", measure_text(number_at(report, "/distortion/area/median"))},
          {"within_4", percent_text(number_at(report, "/distortion/within_4"))},
          {"below_64", percent_text(number_at(report, "/distortion/below_64"))},
          {"energy", measure_text(number_at(report, "/energy"))},
          {"energy_share", measure_text(number_at(report, "/energy") / conformal)},
          {"time", measure_text(number_at(report, "/timings/total"), " s")},
          {"memory", measure_text(number_at(report, "/peak_memory_bytes") / 1e6, " MB")}};
}

Content check_rows(const Certificate& certificate) {
  Content rows = Content::array();
  for (const Check& check : certificate.checks)
    rows.push_back({{"name", check.name},
                    {"meaning", check_meaning(check.name)},
                    {"detail", unless_empty(check.detail)},
                    {"value", fmt::format("{:.4g}", check.value)},
                    {"bound", fmt::format("{:.4g}", check.bound)},
                    {"passed", check.passed}});
  return rows;
}

/// The report's history; numbers that are missing or of another type are 0.
std::vector<Iteration> history_of(const Json& report) {
  const auto number = [](const Json& entry, const char* key) {
    const bool is_given = entry.is_object() && entry.contains(key) && entry[key].is_number();
    return is_given ? entry[key].get<double>() : 0.0;
  };
  std::vector<Iteration> history;
  for (const Json& entry : at(report, "/history"))
    history.push_back({number(entry, "energy"), number(entry, "gradient_norm"), number(entry, "step")});
  return history;
}

Content history_rows(const std::vector<Iteration>& history) {
  Content rows = Content::array();
  for (std::size_t k = 0; k < history.size(); ++k)
    rows.push_back({{"iteration", std::to_string(k)},
                    {"energy", fmt::format("{:.12g}", history[k].energy)},
                    {"gradient_norm", fmt::format("{:.3e}", history[k].gradient_norm)},
                    {"step", fmt::format("{:.3e}", history[k].step)}});
  return rows;
}

// The order, or the angle where there is none.
std::string order_text(const Mark& mark) {
  return mark.order() > 0 ? std::to_string(mark.order())
                          : fmt::format("angle {:.4g} pi", mark.angle / std::numbers::pi);
}

Content cone_rows(const Embedding& embedding) {
  Content rows = Content::array();
  for (std::size_t c = 0; c < embedding.cones.size(); ++c) {
    const ConeCopies& cone = embedding.cones[c];
    rows.push_back({{"colour", hexadecimal(cone_colour(static_cast<int>(c)))},
                    {"vertex", std::to_string(cone.vertex)},
                    {"order", order_text(cone.mark)},
                    {"kind", name_of(cone.mark.kind)},
                    {"copies", std::to_string(cone.copies.size())}});
  }
  return rows;
}

std::string cones_argument(const Embedding& embedding) {
  std::vector<int> vertices;
  for (const ConeCopies& cone : embedding.cones) vertices.push_back(cone.vertex);
  return fmt::format("{}", fmt::join(vertices, ","));
}

Content seam_rows(const Embedding& embedding) {
  Content rows = Content::array();
  for (const Seam& seam : embedding.seams) {
    const Matrix3& M = seam.transform.matrix();
    const double turn = std::acos(std::clamp((M.determinant() * M.trace() - 1) / 2, -1.0, 1.0));
    rows.push_back({{"kind", name_of(seam.kind())},
                    {"vertices", grouped_digits(static_cast<long long>(seam.left.size()))},
                    {"angle", fmt::format("{:.4g}°", turn * 180 / std::numbers::pi)}});
  }
  return rows;
}

Content timing_rows(const Json& report) {
  const Json& stages = at(report, "/timings");
  const double total = number_at(report, "/timings/total");
  Content rows = Content::array();
  if (!stages.is_object()) return rows;
  for (const auto& [stage, value] : stages.items()) {
    if (!value.is_number()) continue;
    const double seconds = value.get<double>();
    const std::string percent = fmt::format("{:.1f}", 100 * std::clamp(seconds / total, 0.0, 1.0));
    rows.push_back({{"stage", stage},
                    {"percent", unless_empty(stage == "total" ? "" : percent)},
                    {"seconds", fmt::format("{:.3f}", seconds)}});
  }
  return rows;
}

// The interactive view

Content picture_list(const std::vector<PagePicture>& pictures) {
  Content list = Content::array();
  for (const PagePicture& picture : pictures)
    list.push_back({{"caption", picture.caption}, {"png", base64(picture.png)}});
  return list;
}

bool is_interactive(const PageOptions& options) { return options.interactive && has_interactive_view(); }

Json parse(const std::string& report) {
  try {
    return Json::parse(report);
  } catch (const nlohmann::json::exception&) {
    throw MeshError("the report is not JSON");
  }
}

void require_match(const PageSubject& subject) {
  const Surface& surface = subject.surface;
  const Embedding& embedding = subject.embedding;
  if (embedding.triangles.rows() != surface.triangles.rows())
    throw MeshError(fmt::format("the embedding has {} faces, the mesh {}: it is not of this mesh",
                                embedding.triangles.rows(), surface.triangles.rows()));
  for (const int v : embedding.source_vertex)
    if (v < 0 || v >= surface.V.rows())
      throw MeshError(fmt::format(
          "the embedding names vertex {}, but the mesh has {}: it is not of this mesh", v, surface.V.rows()));
  if (surface.colours.rows() != 0 && surface.colours.rows() != surface.V.rows())
    throw MeshError(fmt::format("there are colours of {} vertices, but the mesh has {}",
                                surface.colours.rows(), surface.V.rows()));
}

void require_a_value_each(const PageOptions& options, const Surface& surface) {
  if (options.values && options.values->values.size() != surface.V.rows())
    throw MeshError(fmt::format("there are values of {} vertices, but the mesh has {}",
                                options.values->values.size(), surface.V.rows()));
}

/// The last part of the path that the report gives.
std::string mesh_name(const Json& report) {
  const Json& path = at(report, "/mesh/path");
  if (!path.is_string()) return "mesh";
  const std::string file = std::filesystem::path(path.get<std::string>()).filename().string();
  return file.empty() ? "mesh" : file;
}

void add_view(const PageSubject& subject, const PageOptions& options,
              const std::vector<FaceDistortion>& faces, Content& content) {
  content["has_view"] = has_interactive_view();
  content["is_planar"] = !subject.embedding.space().is_closed();
  content["has_pictures"] = !options.pictures.empty();
  content["pictures"] = picture_list(options.pictures);
  std::optional<PageScene> scene;
  if (is_interactive(options)) scene = {"scene", page_scene(subject, faces, options)};
  add_frame(std::move(scene), content);
}

void add_judgement(const Judgement& judgement, const Embedding& embedding, Content& content) {
  const std::vector<Check>& checks = judgement.certificate.checks;
  content["verdict"] = verdict(judgement);
  content["verdict_class"] = judgement.bijective() ? "good" : "bad";
  content["verdict_sentence"] = verdict_sentence(judgement, embedding);
  content["face_verdict"] = face_verdict(judgement.certificate);
  content["passed_checks"] = std::to_string(
      std::count_if(checks.begin(), checks.end(), [](const Check& check) { return check.passed; }));
  content["all_checks"] = std::to_string(checks.size());
  content["checks"] = check_rows(judgement.certificate);
}

/// What fills the template, besides the report's figures.
Content page_content(const PageSubject& subject, const Json& report, const PageOptions& options) {
  const Embedding& embedding = subject.embedding;
  const Judgement judgement = {certify(subject.surface, embedding),
                               at(report, "/termination") == "converged"};
  const std::vector<FaceDistortion> faces = measure_triangles(subject.surface, embedding);
  const std::vector<Iteration> history = history_of(report);
  Content content = {{"mesh_name", mesh_name(report)},
                     {"topology", text_of(embedding.target.topology)},
                     {"signature", embedding.target.signature},
                     {"place", place_in(embedding.space())},
                     {"group", group_text(embedding.target)},
                     {"warnings", warnings(report, judgement)},
                     {"figures", key_figures(report, embedding)},
                     {"histogram", svg_chart(area_histogram(values_of(Measure::area, faces)))},
                     {"convergence", svg_chart(convergence_chart(history))},
                     {"history", history_rows(history)},
                     {"cones", cone_rows(embedding)},
                     {"cones_argument", cones_argument(embedding)},
                     {"seams", seam_rows(embedding)},
                     {"timings", timing_rows(report)}};
  add_judgement(judgement, embedding, content);
  add_view(subject, options, faces, content);
  return content;
}

}  // namespace

bool has_interactive_view() { return !page_script.empty(); }

std::string report_page(const PageSubject& subject, const PageOptions& options) {
  require_match(subject);
  require_a_value_each(options, subject.surface);
  const Json report = parse(subject.report);
  PageOptions possible = options;
  possible.interactive = options.interactive && subject.embedding.space().is_closed();
  Template page = framed_template(page_template,
                                  {{"view", page_view}, {"pictures", page_pictures}, {"chart", page_chart}});
  page.otherwise = [&](const std::string& name) { return named_figure(report, name); };
  return fill_template(page, page_content(subject, report, possible));
}

}  // namespace orbitutte
