// SPDX-License-Identifier: MIT
#include "orbitutte/page/page_scene.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>

#include "orbitutte/export/html_text.h"
#include "orbitutte/export/palette.h"
#include "orbitutte/export/tiling.h"
#include "orbitutte/export/value_colours.h"
#include "orbitutte/page/scene_numbers.h"
#include "orbitutte/report/colour_scale.h"

namespace orbitutte {
namespace {

using Json = nlohmann::ordered_json;

/// The mean of a measure, as log2, over the faces around every cut vertex; 0 if there are no faces.
template <typename Measure>
std::vector<double> vertex_means(const Embedding& embedding, const Measure& measure) {
  std::vector<double> sum(embedding.source_vertex.size(), 0.0);
  std::vector<int> count(sum.size(), 0);
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const double value = measure(f);
    if (!(value > 0)) continue;
    for (const int v : embedding.triangles.row(f)) {
      sum[v] += std::log2(value);
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v) sum[v] /= std::max(count[v], 1);
  return sum;
}

/// The normals of the source at the cut vertices, by area, as the cut mesh's faces run.
Points normals_along_banks(const Surface& surface, const Embedding& embedding) {
  Points normals = Points::Zero(embedding.positions.rows(), 3);
  for (Eigen::Index f = 0; f < embedding.triangles.rows(); ++f) {
    const auto corner = [&](int k) -> Vector3 {
      return surface.V.row(embedding.source_vertex[embedding.triangles(f, k)]);
    };
    const Vector3 normal = (corner(1) - corner(0)).cross(corner(2) - corner(0));
    for (const int v : embedding.triangles.row(f)) normals.row(v) += normal.transpose();
  }
  return normals;
}

/// The same, with the copies of every vertex taken together. The banks of a projective plane's cut face
/// opposite ways, so every copy takes the sum with its own sign.
Points source_normals(const Surface& surface, const Embedding& embedding) {
  Points normals = normals_along_banks(surface, embedding);
  Points sum = Points::Zero(surface.V.rows(), 3);
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    auto total = sum.row(embedding.source_vertex[v]);
    total += (total.dot(normals.row(v)) < 0 ? -1 : 1) * normals.row(v);
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const auto total = sum.row(embedding.source_vertex[v]);
    normals.row(v) = (total.dot(normals.row(v)) < 0 ? -1 : 1) * total.stableNormalized();
  }
  return normals;
}

Json level_json(const DisplayLevel& level) {
  const std::span indices(level.faces.data(), static_cast<std::size_t>(level.faces.size()));
  return {{"indices", packed(level.faces.size(), [&](Eigen::Index i) { return indices[i]; })},
          {"outline", packed(static_cast<Eigen::Index>(2 * level.outline.size()),
                             [&](Eigen::Index i) { return level.outline[i / 2][i % 2]; })}};
}

Json transform_json(const Matrix3& M) {
  Json entries = Json::array();
  for (int i = 0; i < 3; ++i)
    for (int k = 0; k < 3; ++k) entries.push_back(M(i, k));
  return entries;
}

Json copies_json(const Embedding& embedding) {
  Json rows = Json::array();
  for (const TileCopy& copy : tile_copies(embedding)) {
    rows.push_back({{"transform", transform_json(copy.transform.matrix())},
                    {"colour", hexadecimal(tile_colour(copy.colour, copy.mirrored))}});
  }
  return rows;
}

Json cones_json(const Embedding& embedding, const std::vector<int>& cut_vertex) {
  Json rows = Json::array();
  for (std::size_t c = 0; c < embedding.cones.size(); ++c) {
    const ConeCopies& cone = embedding.cones[c];
    Json drawn = Json::array();
    for (const int v : cone.copies) {
      const auto at = std::lower_bound(cut_vertex.begin(), cut_vertex.end(), v);
      if (at != cut_vertex.end() && *at == v) drawn.push_back(at - cut_vertex.begin());
    }
    rows.push_back({{"vertex", cone.vertex},
                    {"order", cone.mark.order()},
                    {"colour", hexadecimal(cone_colour(static_cast<int>(c)))},
                    {"drawn", std::move(drawn)}});
  }
  return rows;
}

/// The values of the drawn vertices, out of those of all cut vertices.
std::vector<double> drawn(const std::vector<double>& values, const std::vector<int>& cut_vertex) {
  std::vector<double> result;
  result.reserve(cut_vertex.size());
  for (const int v : cut_vertex) result.push_back(values[v]);
  return result;
}

void add_positions(const Surface& surface, const Embedding& embedding, const std::vector<int>& cut_vertex,
                   Json& scene) {
  const auto count = static_cast<Eigen::Index>(3 * cut_vertex.size());
  const Vector3 low = surface.V.colwise().minCoeff();
  const double size = std::max((surface.V.colwise().maxCoeff().transpose() - low).maxCoeff(), 1e-300);
  scene["source_box"] = {low[0], low[1], low[2], size};
  scene["source"] = packed(count, [&](Eigen::Index i) {
    const int v = embedding.source_vertex[cut_vertex[i / 3]];
    return quantised(surface.V(v, i % 3), low[i % 3], size);
  });
  scene["image"] = packed(count, [&](Eigen::Index i) {
    return static_cast<float>(embedding.positions(cut_vertex[i / 3], i % 3));
  });
  const Points normals = source_normals(surface, embedding);
  scene["normal"] = packed(count, [&](Eigen::Index i) {
    return static_cast<std::int8_t>(std::lround(127 * normals(cut_vertex[i / 3], i % 3)));
  });
  scene["source_vertex"] = packed(count / 3, [&](Eigen::Index i) {
    return static_cast<std::uint32_t>(embedding.source_vertex[cut_vertex[i]]);
  });
}

void add_distortion(const Embedding& embedding, const std::vector<FaceDistortion>& faces,
                    const std::vector<int>& cut_vertex, Json& scene) {
  const auto add = [&](const std::string& name, const auto& measure) {
    const std::vector<double> values = drawn(vertex_means(embedding, measure), cut_vertex);
    const ValueRange range = range_of(values);
    scene[name + "_range"] = range_json(range);
    scene[name] =
        packed(static_cast<Eigen::Index>(values.size()), [&](Eigen::Index i) { return range(values[i]); });
  };
  add("area", [&](Eigen::Index f) { return faces[f].area; });
  add("angle", [&](Eigen::Index f) { return faces[f].angle; });
}

Json scale_json(Measure measure, const std::vector<FaceDistortion>& faces) {
  return scale_json(colour_scale(measure, values_of(measure, faces)));
}

void add_colours(const Points& colours, const Embedding& embedding, const std::vector<int>& cut_vertex,
                 Json& scene) {
  if (colours.rows() == 0) return;
  scene["colour"] = packed(static_cast<Eigen::Index>(3 * cut_vertex.size()), [&](Eigen::Index i) {
    const double channel = colours(embedding.source_vertex[cut_vertex[i / 3]], i % 3);
    return static_cast<std::uint8_t>(std::lround(255 * std::clamp(channel, 0.0, 1.0)));
  });
}

Json values_json(const ShownValues& shown, const Embedding& embedding, const std::vector<int>& cut_vertex) {
  Json json = {{"name", shown.name}};
  json["numbers"] = packed(static_cast<Eigen::Index>(cut_vertex.size()), [&](Eigen::Index i) {
    return static_cast<float>(shown.values[embedding.source_vertex[cut_vertex[i]]]);
  });
  if (shown.labels.empty()) return json;
  json["labels"] = Json::array();
  for (const ValueLabel& label : shown.labels) json["labels"].push_back({label.key, label.name});
  return json;
}

// The scale of values, as scale_json has those of distortions.
Json scale_of_values_json(const ShownValues& shown) {
  constexpr int steps = 4, colours = 256;
  Json json = {{"low", shown.low}, {"high", shown.high}, {"title", shown.name}};
  json["ticks"] = json["colours"] = Json::array();
  for (int k = 0; k <= steps; ++k) {
    const double share = k / static_cast<double>(steps);
    json["ticks"].push_back(
        {{"at", share}, {"text", fmt::format("{:.3g}", shown.low + share * (shown.high - shown.low))}});
  }
  for (const Rgb& colour : value_scale_colours(shown.low, shown.high, colours))
    json["colours"].push_back(hexadecimal(colour));
  return json;
}

// A name may hold anything; within a string, \u003c is <.
std::string within_script(std::string json) {
  for (std::size_t at = 0; (at = json.find('<', at)) != std::string::npos;) json.replace(at, 1, "\\u003c");
  return json;
}

}  // namespace

std::string page_scene(const PageSubject& subject, const std::vector<FaceDistortion>& faces,
                       const PageOptions& options) {
  const auto& [surface, embedding, report] = subject;
  const DisplayMesh display = display_mesh(surface, embedding, options.limits);
  Json scene = {{"faces", embedding.triangles.rows()},
                {"shown_faces", display.fine.faces.rows()},
                {"copy_faces", display.coarse.faces.rows()},
                {"vertices", display.cut_vertex.size()}};
  add_positions(surface, embedding, display.cut_vertex, scene);
  add_distortion(embedding, faces, display.cut_vertex, scene);
  add_colours(surface.colours, embedding, display.cut_vertex, scene);
  scene["fine"] = level_json(display.fine);
  scene["coarse"] = level_json(display.coarse);
  scene["copies"] = copies_json(embedding);
  scene["cones"] = cones_json(embedding, display.cut_vertex);
  scene["scales"] = {{"area", scale_json(Measure::area, faces)},
                     {"angle", scale_json(Measure::angle, faces)}};
  if (options.values) {
    scene["values"] = values_json(*options.values, embedding, display.cut_vertex);
    if (options.values->high > options.values->low)
      scene["scales"]["vertex"] = scale_of_values_json(*options.values);
  }
  scene["tile"] = hexadecimal(bold_colour);
  scene["ink"] = hexadecimal(ink::text);
  return within_script(scene.dump(-1, ' ', false, Json::error_handler_t::replace));
}

}  // namespace orbitutte
