// SPDX-License-Identifier: MIT
#include "orbitutte/page/map_page.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <utility>

#include "orbitutte/errors.h"
#include "orbitutte/export/common_view.h"
#include "orbitutte/export/html_text.h"
#include "orbitutte/export/overlay_pieces.h"
#include "orbitutte/export/palette.h"
#include "orbitutte/page/html_template.h"
#include "orbitutte/page/page.h"
#include "orbitutte/page/page_assets.h"
#include "orbitutte/page/page_frame.h"
#include "orbitutte/page/scene_numbers.h"
#include "orbitutte/report/overlay_distortion.h"

namespace orbitutte {
namespace {

using SceneJson = nlohmann::ordered_json;

constexpr int most_triangles_of_page = 4000000;

// n x 3: the unit normals of a surface's vertices, by area; zero where no face is.
Points vertex_normals(const Surface& surface) {
  Points normals = Points::Zero(surface.V.rows(), 3);
  for (int t = 0; t < surface.triangle_count(); ++t) {
    const auto v = surface.triangles.row(t);
    const Vector3 a = surface.V.row(v[0]), b = surface.V.row(v[1]), c = surface.V.row(v[2]);
    const Vector3 normal = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) normals.row(v[k]) += normal.transpose();
  }
  normals.rowwise().normalize();
  return normals;
}

// One surface as the page shows it: positions and normals at the overlay's vertices.
struct ShownSide {
  Points positions, normals;
};

ShownSide side_of(const Surface& surface, const Embedding& embedding, const SurfacePoints& points) {
  return {positions_on(surface.V, embedding, points),
          positions_on(vertex_normals(surface), embedding, points)};
}

void turn(ShownSide& side, const Matrix3& rotation) {
  side.positions *= rotation;
  side.normals *= rotation;
}

void add_side(const ShownSide& side, const std::string& name, SceneJson& scene) {
  const Eigen::RowVector3d low = side.positions.colwise().minCoeff();
  const double size = std::max((side.positions.colwise().maxCoeff() - low).maxCoeff(), 1e-300);
  const Eigen::Index count = side.positions.size();
  scene[name + "_box"] = {low[0], low[1], low[2], size};
  scene[name] = packed(
      count, [&](Eigen::Index i) { return quantised(side.positions(i / 3, i % 3), low[i % 3], size); });
  scene[name + "_normal"] = packed(count, [&](Eigen::Index i) {
    const double length = std::max(side.normals.row(i / 3).norm(), 1e-300);
    return static_cast<std::int8_t>(std::lround(127 * side.normals(i / 3, i % 3) / length));
  });
}

// Means over the triangles around every vertex, by their areas on A; `otherwise` where there are none.
template <typename Value>
std::vector<double> means_at_vertices(const OverlayPieces& pieces, const Points& on_a, const Value& value,
                                      double otherwise) {
  std::vector<double> sums(static_cast<std::size_t>(on_a.rows()), 0), weights(sums.size(), 0);
  for (int t = 0; t < pieces.count(); ++t) {
    const double number = value(t);
    if (!std::isfinite(number)) continue;
    const auto v = pieces.triangles.row(t);
    const Vector3 a = on_a.row(v[0]), b = on_a.row(v[1]), c = on_a.row(v[2]);
    const double weight = (b - a).cross(c - a).norm();
    for (int k = 0; k < 3; ++k) {
      sums[v[k]] += weight * number;
      weights[v[k]] += weight;
    }
  }
  for (std::size_t v = 0; v < sums.size(); ++v) sums[v] = weights[v] > 0 ? sums[v] / weights[v] : otherwise;
  return sums;
}

void add_values(const std::string& name, const std::vector<double>& values, SceneJson& scene) {
  const ValueRange range = range_of(values);
  scene[fmt::format("{}_range", name)] = range_json(range);
  scene[name] =
      packed(static_cast<Eigen::Index>(values.size()), [&](Eigen::Index i) { return range(values[i]); });
}

void add_map_distortion(const MapPageSubject& subject, const OverlayPieces& pieces, SceneJson& scene) {
  const Points& on_a = subject.composed.overlay_on_a;
  const std::vector<PieceDistortion> distortion =
      piece_distortions(pieces.triangles, on_a, subject.composed.overlay_on_b);
  const ColourScale areas = map_area_scale(piece_log_areas(distortion)),
                    energies = map_energy_scale(piece_energies(distortion));
  // What lies far beyond the scale's ends would leave too few of the 16 bits to what lies within.
  const auto clamped = [](const ColourScale& scale, double value) {
    const double width = scale.axis.high - scale.axis.low;
    return std::clamp(value, scale.axis.low - width, scale.axis.high + width);
  };
  add_values("area",
             means_at_vertices(
                 pieces, on_a, [&](int t) { return clamped(areas, std::log2(distortion[t].area)); }, 0),
             scene);
  add_values(
      "energy",
      means_at_vertices(
          pieces, on_a, [&](int t) { return clamped(energies, distortion[t].symmetric_dirichlet); }, 1),
      scene);
  scene["scales"] = {{"area", scale_json(areas)}, {"energy", scale_json(energies)}};
}

void add_vertices(const Overlay& overlay, SceneJson& scene) {
  const auto count = static_cast<Eigen::Index>(overlay.vertices.size());
  scene["a_vertex"] =
      packed(count, [&](Eigen::Index i) { return static_cast<std::uint32_t>(overlay.vertices[i].a_vertex); });
  scene["b_vertex"] =
      packed(count, [&](Eigen::Index i) { return static_cast<std::uint32_t>(overlay.vertices[i].b_vertex); });
}

SceneJson landmarks_of_page(const MapPageSubject& subject) {
  std::vector<int> vertex_at(static_cast<std::size_t>(subject.a.V.rows()), -1);
  const std::vector<OverlayVertex>& vertices = subject.composed.overlay.vertices;
  for (std::size_t k = 0; k < vertices.size(); ++k)
    if (vertices[k].a_vertex >= 0) vertex_at[vertices[k].a_vertex] = static_cast<int>(k);
  SceneJson rows = SceneJson::array();
  for (const Landmark& landmark : subject.map.landmarks)
    rows.push_back({{"a", landmark.a},
                    {"b", landmark.b},
                    {"at", vertex_at[landmark.a]},
                    {"colour", hexadecimal(cone_colour(static_cast<int>(rows.size())))}});
  return rows;
}

std::string number_text(double value) { return std::isfinite(value) ? fmt::format("{:.4g}", value) : "–"; }

Content landmark_rows(const MapPageSubject& subject) {
  Content rows = Content::array();
  for (const Landmark& landmark : subject.map.landmarks)
    rows.push_back({{"a", std::to_string(landmark.a)},
                    {"b", std::to_string(landmark.b)},
                    {"number", std::to_string(rows.size() + 1)},
                    {"colour", hexadecimal(cone_colour(static_cast<int>(rows.size())))}});
  return rows;
}

Content check_rows_of_overlay(const OverlayCertificate& certificate) {
  Content rows = Content::array();
  for (const Check& check : certificate.checks)
    rows.push_back({{"name", check.name},
                    {"detail", check.detail.empty() ? Content(false) : Content(check.detail)},
                    {"passed", check.passed}});
  return rows;
}

Content map_content(const MapPageSubject& subject) {
  const MapDistortion& distortion = subject.composed.distortion;
  const bool certified = subject.map.is_bijective() && subject.composed.certificate.holds;
  return {{"name_of_a", subject.name_of_a},
          {"name_of_b", subject.name_of_b},
          {"signature", subject.map.target().signature},
          {"verdict", certified ? "Certified bijective" : "Not certified"},
          {"verdict_class", certified ? "good" : "bad"},
          {"warnings", subject.map.warnings},
          {"landmark_count", std::to_string(subject.map.landmarks.size())},
          {"vertices", grouped_digits(subject.composed.overlay.vertex_count())},
          {"faces", grouped_digits(subject.composed.overlay.face_count())},
          {"mean", number_text(distortion.symmetric_dirichlet.mean)},
          {"median", number_text(distortion.symmetric_dirichlet.median)},
          {"percentile_90", number_text(distortion.symmetric_dirichlet.percentile_90)},
          {"within_4", fmt::format("{:.1f} %", 100 * distortion.within_4)},
          {"landmark_error", number_text(subject.composed.landmark_error)},
          {"has_colours", subject.b.colours.rows() > 0},
          {"landmarks", landmark_rows(subject)},
          {"checks", check_rows_of_overlay(subject.composed.certificate)}};
}

}  // namespace

std::string map_scene(const MapPageSubject& subject) {
  const OverlayPieces pieces = overlay_pieces(subject.composed.overlay);
  if (pieces.count() > most_triangles_of_page)
    throw ArgumentError(fmt::format(
        "a page of {} triangles is more than browsers show; map coarser meshes for it", pieces.count()));
  const Overlay& overlay = subject.composed.overlay;
  const Embedding &a = subject.map.a.embedding, &b = subject.map.b.embedding;
  const ShownSide on_a = side_of(subject.a, a, overlay.on_a);
  ShownSide on_b = side_of(subject.b, b, overlay.on_b);
  const Matrix3 rotation = turn_of_views(on_a.positions, on_b.positions);
  turn(on_b, rotation);
  SceneJson scene = {{"vertices", overlay.vertex_count()}, {"faces", pieces.count()}};
  add_side(on_a, "a", scene);
  add_side(on_b, "b", scene);
  scene["turn"] = SceneJson::array();
  for (int k = 0; k < 9; ++k) scene["turn"].push_back(rotation(k / 3, k % 3));
  const Points colours = positions_on(shown_colours(subject.b), b, overlay.on_b);
  scene["colour"] = packed(colours.size(), [&](Eigen::Index i) {
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(colours(i / 3, i % 3), 0.0, 1.0)));
  });
  scene["has_colours"] = subject.b.colours.rows() > 0;
  add_map_distortion(subject, pieces, scene);
  add_vertices(overlay, scene);
  const std::span indices(pieces.triangles.data(), static_cast<std::size_t>(pieces.triangles.size()));
  scene["indices"] = packed(pieces.triangles.size(), [&](Eigen::Index i) { return indices[i]; });
  scene["landmarks"] = landmarks_of_page(subject);
  scene["plain"] = hexadecimal(bold_colour);
  scene["ink"] = hexadecimal(ink::text);
  return scene.dump();
}

std::string map_page(const MapPageSubject& subject) {
  Content content = map_content(subject);
  std::optional<PageScene> scene;
  if (has_interactive_view()) scene = {"linked-scene", map_scene(subject)};
  add_frame(std::move(scene), content);
  return fill_template(framed_template(map_page_template, {{"view", map_page_view}}), content);
}

}  // namespace orbitutte
