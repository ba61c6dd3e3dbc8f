// SPDX-License-Identifier: MIT
#include "orbitutte/page/page.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <numbers>

#include "orbitutte/export/html_text.h"
#include "orbitutte/page/page_assets.h"
#include "orbitutte/page/page_charts.h"
#include "orbitutte/page/page_scene.h"
#include "orbitutte/report/report.h"
#include "orbitutte/verify/certificate.h"
#include "orbitutte/version.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;
using Pointer = Json::json_pointer;
using Slots = std::map<std::string, std::string>;

constexpr const char* missing = "&ndash;";

// Figures of the report: a dash where one is missing or of another type.

const Json& at(const Json& report, const char* path) {
  static const Json nothing;
  const Pointer pointer(path);
  return report.contains(pointer) ? report.at(pointer) : nothing;
}

double number_at(const Json& report, const char* path) {
  const Json& value = at(report, path);
  return value.is_number() ? value.get<double>() : std::numeric_limits<double>::quiet_NaN();
}

/// A value as HTML: whole numbers with commas, others to six digits.
std::string value_html(const Json& value) {
  if (value.is_number_integer()) return grouped_digits(value.get<long long>());
  if (value.is_number()) return fmt::format("{:.6g}", value.get<double>());
  if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
  if (value.is_string() && !value.get<std::string>().empty()) return escape_html(value.get<std::string>());
  return missing;
}

std::string figure_html(const Json& report, const char* path) { return value_html(at(report, path)); }

std::string measure_html(double value, const char* unit = "") {
  return std::isfinite(value) ? fmt::format("{:.4g}{}", value, unit) : missing;
}

// Pieces of HTML. Arguments are HTML already.

std::string row(const std::vector<std::string>& cells) {
  std::string html = "<tr>";
  for (std::size_t k = 0; k < cells.size(); ++k)
    html += k == 0 ? "<th scope=\"row\">" + cells[k] + "</th>" : "<td class=\"value\">" + cells[k] + "</td>";
  return html + "</tr>\n";
}

std::string head(const std::vector<std::string>& cells) {
  std::string html = "<thead><tr>";
  for (std::size_t k = 0; k < cells.size(); ++k)
    html += fmt::format("<th scope=\"col\"{}>{}</th>", k == 0 ? "" : " class=\"value\"", cells[k]);
  return html + "</tr></thead>\n";
}

std::string table(const std::string& header, const std::string& rows) {
  return "<table>" + header + "<tbody>\n" + rows + "</tbody></table>";
}

std::string paragraph(const char* css_class, const std::string& html) {
  return fmt::format("<p class=\"{}\">{}</p>\n", css_class, html);
}

std::string details(const std::string& summary, const std::string& html) {
  return "<details><summary>" + summary + "</summary>\n" + html + "</details>\n";
}

// Words

std::string plural(long long count, const std::string& noun) {
  return fmt::format("{} {}{}", grouped_digits(count), noun, count == 1 ? "" : "s");
}

/// What a check of the certificate asks.
std::string check_meaning(const std::string& name) {
  static const std::map<std::string, std::string> meanings = {
      {"cut_mesh", "The embedding has the input's faces and vertices: offences"},
      {"unit_positions", "Positions are unit vectors: largest error"},
      {"seam_gluing", "Seams pair the whole boundary of one disk, once: offences"},
      {"seam_transforms", "Seams are glued by rotations and reflections: offences"},
      {"cones", "Cones and corners are those of the orbifold: offences"},
      {"group_order", "Order of the group that the seams generate"},
      {"seam_residual", "Paired positions match: largest difference"},
      {"positive_faces", "Triangles not positively oriented, by exact signs"},
      {"edge_lengths", "Longest edge, below &pi;"},
      {"convex_faces", "Polygons are convex: faces that are not"},
      {"held_sides", "Boundary vertices lie on the polygon's sides, in order: largest error"},
      {"cone_angles", "Angles at cones and corners: largest error"},
      {"signed_area", "Total area is the tile's, 4&pi;/|G|, or the polygon's: error"}};
  const auto found = meanings.find(name);
  return found == meanings.end() ? escape_html(name) : found->second;
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
    if (!check.passed) names.push_back("<code>" + escape_html(check.name) + "</code>");
  return fmt::format("{}", fmt::join(names, ", "));
}

std::string verdict_sentence(const Judgement& judgement, const Embedding& embedding) {
  if (judgement.bijective())
    return fmt::format(
        "The map is a bijection: {} the sphere exactly once, which the certificate below proves on the "
        "stored numbers.",
        embedding.target.group_order == 1
            ? "the tile covers"
            : fmt::format("its {} symmetric copies cover", embedding.target.group_order));
  if (judgement.certificate.bijective)
    return "The optimiser stopped before it converged: the map passes every check, but it is not the "
           "minimiser.";
  return "The map is not certified as a bijection; these checks fail: " +
         failed_checks(judgement.certificate) + ".";
}

std::string face_noun(const Embedding& embedding) {
  return embedding.polygons.count() > 0 ? "face" : "triangle";
}

std::string summary(const Json& report, const Embedding& embedding, const Judgement& judgement) {
  return fmt::format(
      "A {} of {} vertices and {} {}, mapped onto the orbifold <b>{}</b>, whose group has {}. {}",
      figure_html(report, "/mesh/topology"), figure_html(report, "/mesh/vertices"),
      figure_html(report, "/mesh/faces"), face_noun(embedding) + "s", escape_html(embedding.target.signature),
      plural(embedding.target.group_order, "element"), verdict_sentence(judgement, embedding));
}

std::string warnings(const Json& report, const Judgement& judgement) {
  std::string html;
  const Json& claim = at(report, "/certificate/bijective");
  if (claim.is_boolean() && claim.get<bool>() != judgement.bijective())
    html += paragraph(
        "warning", fmt::format("The report says &ldquo;bijective: {}&rdquo;, the certificate computed from "
                               "the files says otherwise. This page follows the files.",
                               claim.get<bool>()));
  for (const Json& warning : at(report, "/warnings"))
    if (warning.is_string()) html += paragraph("warning", escape_html(warning.get<std::string>()));
  return html;
}

// Sections

std::string figure(const std::string& name, const std::string& value) {
  return "<div><dt>" + name + "</dt><dd>" + value + "</dd></div>\n";
}

std::string key_figures(const Json& report, const Embedding& embedding) {
  const double conformal = 8 * std::numbers::pi / embedding.target.group_order;
  return figure("angle distortion, mean", measure_html(number_at(report, "/distortion/angle/mean"))) +
         figure("area distortion, median", measure_html(number_at(report, "/distortion/area/median"))) +
         figure("energy", measure_html(number_at(report, "/energy"))) +
         figure("energy over that of a conformal map",
                measure_html(number_at(report, "/energy") / conformal)) +
         figure("iterations", figure_html(report, "/iterations")) +
         figure("time in all", measure_html(number_at(report, "/timings/total"), " s")) +
         figure("peak memory", measure_html(number_at(report, "/peak_memory_bytes") / 1e6, " MB"));
}

std::string certificate_table(const Certificate& certificate) {
  std::string rows;
  for (const Check& check : certificate.checks) {
    const std::string state =
        check.passed ? "<span class=\"state good\">&#10003; <span class=\"word\">passed</span></span>"
                     : "<span class=\"state bad\">&#10007; <span class=\"word\">failed</span></span>";
    const std::string detail = check.detail.empty() ? "" : "<br><b>" + escape_html(check.detail) + "</b>";
    rows += fmt::format(
        "<tr><th scope=\"row\">{}{}<br><code class=\"fine\">{}</code></th><td class=\"value\">{:.4g}</td>"
        "<td class=\"value\">{:.4g}</td><td class=\"value\">{}</td></tr>\n",
        check_meaning(check.name), detail, escape_html(check.name), check.value, check.bound, state);
  }
  return table(head({"Check", "Value", "Bound", ""}), rows);
}

std::string certificate_intro(const Certificate& certificate, const std::string& face) {
  return fmt::format(
      "Computed again from the mesh and the embedding when this page was written, by code that the solver "
      "does not "
      "share. {}; {} of {} checks passed. <code>orbitutte verify</code> repeats it.",
      certificate.nonpositive_faces.empty()
          ? "Every " + face + " is positively oriented"
          : plural(static_cast<long long>(certificate.nonpositive_faces.size()), face) +
                " not positively oriented",
      std::count_if(certificate.checks.begin(), certificate.checks.end(),
                    [](const Check& c) { return c.passed; }),
      certificate.checks.size());
}

std::vector<double> numbers(const Json& list) {
  std::vector<double> values;
  for (const Json& value : list)
    if (value.is_number()) values.push_back(value.get<double>());
  return values;
}

std::string histogram(const Json& report) {
  const std::string svg = histogram_svg({numbers(at(report, "/distortion/histogram/edges")),
                                         numbers(at(report, "/distortion/histogram/counts"))});
  if (svg.empty()) return {};
  return svg +
         paragraph("fine",
                   "Triangles by how much of the tile they take, relative to their share of the source. "
                   "The outermost bins hold all beyond.");
}

std::string distortion_table(const Json& report) {
  return table(
             head({"", "mean", "median", "std", "max"}),
             row({"area, max(A, 1/A)", figure_html(report, "/distortion/area/mean"),
                  figure_html(report, "/distortion/area/median"), figure_html(report, "/distortion/area/std"),
                  figure_html(report, "/distortion/area/max")}) +
                 row({"angle, &sigma;<sub>1</sub>/&sigma;<sub>2</sub>",
                      figure_html(report, "/distortion/angle/mean"), missing, missing,
                      figure_html(report, "/distortion/angle/max")})) +
         paragraph("fine", figure_html(report, "/distortion/measured_faces") + " triangles measured.");
}

std::vector<double> history_column(const Json& report, const char* key) {
  std::vector<double> values;
  for (const Json& entry : at(report, "/history")) {
    const bool given = entry.is_object() && entry.contains(key) && entry[key].is_number();
    values.push_back(given ? entry[key].get<double>() : 0);
  }
  return values;
}

std::string convergence(const Json& report) {
  std::vector<double> excess = history_column(report, "energy");
  const double energy = excess.empty() ? 0 : excess.back();
  for (double& value : excess) value = (value - energy) / energy;
  return convergence_svg({{"gradient norm", history_column(report, "gradient_norm")},
                          {"energy above the last, relative", std::move(excess)}});
}

std::string history_table(const Json& report) {
  const std::vector<double> energy = history_column(report, "energy"),
                            gradient = history_column(report, "gradient_norm"),
                            step = history_column(report, "step");
  std::string rows;
  for (std::size_t k = 0; k < energy.size(); ++k)
    rows += row({std::to_string(k), fmt::format("{:.12g}", energy[k]), fmt::format("{:.3e}", gradient[k]),
                 fmt::format("{:.3e}", step[k])});
  return details("Every iteration",
                 "<div class=\"wide\">" +
                     table(head({"Iteration", "Energy", "Gradient norm", "Largest move"}), rows) + "</div>");
}

std::string convergence_table(const Json& report) {
  return table("", row({"termination", figure_html(report, "/termination")}) +
                       row({"iterations", figure_html(report, "/iterations")}) +
                       row({"evaluations", figure_html(report, "/evaluations")}) +
                       row({"energy", figure_html(report, "/energy")}) +
                       row({"gradient norm", figure_html(report, "/gradient_norm")})) +
         history_table(report);
}

std::string cones_table(const Embedding& embedding) {
  std::string rows;
  std::vector<int> vertices;
  for (const ConeCopies& cone : embedding.cones) {
    vertices.push_back(cone.vertex);
    rows += row({std::to_string(cone.vertex), std::to_string(cone.mark.order()), name(cone.mark.kind),
                 std::to_string(cone.copies.size())});
  }
  return table(head({"Vertex", "Order", "Kind", "Copies"}), rows) +
         fmt::format("<p><code>--cones {}</code></p>", fmt::join(vertices, ","));
}

std::string seams_table(const Embedding& embedding) {
  std::string rows;
  for (const Seam& seam : embedding.seams)
    rows += row(
        {name(seam.kind()), grouped_digits(static_cast<long long>(seam.left.size())),
         fmt::format("{:.4g}&deg;",
                     std::acos(std::clamp(
                         (seam.transform.matrix().determinant() * seam.transform.matrix().trace() - 1) / 2,
                         -1.0, 1.0)) *
                         180 / std::numbers::pi)});
  return table(head({"Seam", "Vertices", "Angle"}), rows);
}

std::string timings(const Json& report) {
  const Json& stages = at(report, "/timings");
  const double total = number_at(report, "/timings/total");
  std::string rows;
  if (stages.is_object())
    for (const auto& [stage, seconds] : stages.items())
      if (seconds.is_number())
        rows += fmt::format(
            "<tr><th scope=\"row\">{}</th><td class=\"bar\">{}</td><td class=\"value\">{:.3f} s</td></tr>\n",
            escape_html(stage), stage == "total" ? "" : bar_svg(seconds.get<double>() / total),
            seconds.get<double>());
  return table("", rows);
}

std::string environment(const Json& report) {
  static constexpr std::array<std::array<const char*, 2>, 17> lines = {
      {{"mesh", "/mesh/path"},
       {"vertices", "/mesh/vertices"},
       {"faces", "/mesh/faces"},
       {"unreferenced vertices", "/mesh/unreferenced_vertices"},
       {"faces without area", "/mesh/zero_area_faces"},
       {"SHA-256", "/environment/input_sha256"},
       {"weights", "/weights/kind"},
       {"clamp", "/weights/clamp"},
       {"clamped edges", "/weights/clamped_edges"},
       {"signed area", "/certificate/signed_area"},
       {"expected area", "/certificate/expected_area"},
       {"longest edge", "/certificate/max_edge_length"},
       {"peak memory, bytes", "/peak_memory_bytes"},
       {"version", "/environment/version"},
       {"commit", "/environment/commit"},
       {"solver", "/environment/backend"},
       {"BLAS", "/environment/blas"}}};
  std::string rows;
  for (const auto& [label, path] : lines)
    rows += fmt::format("<tr><th scope=\"row\">{}</th><td class=\"path\">{}</td></tr>\n", label,
                        figure_html(report, path));
  rows += fmt::format("<tr><th scope=\"row\">threads</th><td class=\"path\">{}</td></tr>\n",
                      figure_html(report, "/environment/threads"));
  return table("", rows);
}

// The interactive view

std::string pictures(const std::vector<PagePicture>& pictures) {
  if (pictures.empty()) return {};
  std::string html = "<div id=\"pictures\" class=\"pictures\">\n";
  for (const PagePicture& picture : pictures)
    html += fmt::format(
        "<figure><img alt=\"{0}\" src=\"data:image/png;base64,{1}\"><figcaption>{0}</figcaption></figure>\n",
        escape_html(picture.caption), base64(picture.png));
  return html + "</div>\n";
}

bool is_interactive(const PageOptions& options) { return options.interactive && has_interactive_view(); }

std::string view(const PageOptions& options) {
  if (is_interactive(options)) return fill_slots(page_view, {{"pictures", pictures(options.pictures)}});
  return paragraph("notice",
                   fmt::format("The interactive 3D view was left out of this page{}. All figures are below.",
                               has_interactive_view() ? "" : ", since orbitutte was built without Node.js")) +
         pictures(options.pictures);
}

std::string scripts(const PageSubject& subject, const PageOptions& options) {
  if (!is_interactive(options)) return {};
  return "<script type=\"application/json\" id=\"scene\">" +
         page_scene(subject.surface, subject.embedding, options.limits) + "</script>\n<script>" +
         std::string(page_script) + "</script>";
}

std::string licences(const PageOptions& options) {
  if (!is_interactive(options)) return {};
  return details("Licences of the software in this page",
                 "<p>The interactive view contains three.js and three-mesh-bvh.</p><pre>" +
                     escape_html(page_licences) + "</pre>");
}

/// For a content security policy: what the text hashes to.
std::string policy_hash(std::string_view text) {
  const std::string digits = sha256(text);
  std::string digest;
  for (std::size_t k = 0; k < digits.size(); k += 2)
    digest += static_cast<char>(std::stoi(digits.substr(k, 2), nullptr, 16));
  return "'sha256-" + base64(digest) + "'";
}

/// Nothing is loaded, sent or run but the page's own script and style.
std::string policy(const PageOptions& options) {
  return fmt::format(
      "default-src 'none'; script-src {}; style-src {}; img-src data:; base-uri 'none'; form-action 'none'",
      is_interactive(options) ? policy_hash(page_script) : "'none'", policy_hash(page_style));
}

Json parse(const std::string& report) {
  try {
    return Json::parse(report);
  } catch (const nlohmann::json::exception&) {
    throw MeshError("the report is no JSON");
  }
}

void require_match(const PageSubject& subject) {
  const Surface& surface = subject.surface;
  const Embedding& embedding = subject.embedding;
  if (embedding.faces.rows() != surface.triangles.rows())
    throw MeshError(fmt::format("the embedding has {} faces, the mesh {}: it is not of this mesh",
                                embedding.faces.rows(), surface.triangles.rows()));
  for (const int v : embedding.source_vertex)
    if (v < 0 || v >= surface.V.rows())
      throw MeshError(fmt::format(
          "the embedding names vertex {}, but the mesh has {}: it is not of this mesh", v, surface.V.rows()));
  if (surface.colours.rows() != 0 && surface.colours.rows() != surface.V.rows())
    throw MeshError(fmt::format("there are colours of {} vertices, but the mesh has {}",
                                surface.colours.rows(), surface.V.rows()));
}

/// The last part of the path that the report gives.
std::string mesh_name(const Json& report) {
  const Json& path = at(report, "/mesh/path");
  if (!path.is_string()) return "mesh";
  const std::string file = std::filesystem::path(path.get<std::string>()).filename().string();
  return file.empty() ? "mesh" : file;
}

Slots slots(const PageSubject& subject, const PageOptions& options) {
  const Json report = parse(subject.report);
  const Embedding& embedding = subject.embedding;
  const Judgement judgement = {certify(subject.surface, embedding),
                               at(report, "/termination") == "converged"};
  const std::string name = escape_html(mesh_name(report)),
                    signature = escape_html(embedding.target.signature);
  return {{"policy", policy(options)},
          {"style", std::string(page_style)},
          {"title", name + " onto " + signature},
          {"mesh_name", name},
          {"signature", signature},
          {"verdict", verdict(judgement)},
          {"verdict_class", judgement.bijective() ? "good" : "bad"},
          {"summary", summary(report, embedding, judgement)},
          {"warnings", warnings(report, judgement)},
          {"view", view(options)},
          {"figures", key_figures(report, embedding)},
          {"certificate_intro", certificate_intro(judgement.certificate, face_noun(embedding))},
          {"certificate", certificate_table(judgement.certificate)},
          {"histogram", histogram(report)},
          {"distortion", distortion_table(report)},
          {"convergence", convergence(report)},
          {"convergence_table", convergence_table(report)},
          {"cones", cones_table(embedding)},
          {"seams", seams_table(embedding)},
          {"timings", timings(report)},
          {"environment", environment(report)},
          {"version", version},
          {"licences", licences(options)},
          {"scripts", scripts(subject, options)}};
}

}  // namespace

bool has_interactive_view() { return !page_script.empty(); }

std::string report_page(const PageSubject& subject, const PageOptions& options) {
  require_match(subject);
  return fill_slots(page_template, slots(subject, options));
}

}  // namespace orbitutte
