// SPDX-License-Identifier: MIT
#include "orbitutte/export/export.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

#include "orbitutte/export/cut_triangles.h"
#include "orbitutte/export/export_files.h"
#include "orbitutte/export/gltf_model.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/obj_lines.h"
#include "orbitutte/io/ply.h"
#include "orbitutte/io/ply_triangles.h"
#include "orbitutte/names.h"

namespace orbitutte {
namespace {

// The row of texture coordinates of every corner of the input.
std::vector<int> texture_rows(const ExportedModel& model) {
  const FaceView faces = model.surface.faces();
  std::vector<int> rows;
  rows.reserve(faces.start(faces.count()));
  for (int f = 0; f < faces.count(); ++f)
    for (int k = 0; k < faces.degree(f); ++k)
      rows.push_back(
          model.texture.of_corner[faces.start(f) + cut_corner(model.surface, model.embedding, f, k)]);
  return rows;
}

// The corner of the surface's faces at which a half-edge of its triangles begins.
int corner_of(const Surface& surface, int h) {
  return surface.has_polygons() ? surface.division.data()[h] : h;
}

// The source vertex of every row of texture coordinates.
std::vector<int> source_of_texture_vertex(const ExportedModel& model, const std::vector<int>& rows) {
  std::vector<int> source = model.embedding.source_vertex;
  source.resize(model.texture.uv.rows(), 0);
  const FaceView faces = model.surface.faces();
  for (int f = 0; f < faces.count(); ++f)
    for (int k = 0; k < faces.degree(f); ++k) source[rows[faces.start(f) + k]] = faces[f][k];
  return source;
}

// The mean distortion of a range of triangles, weighted by their areas in the source. Triangles that were not
// measured do not count.
FaceDistortion mean_distortion(const Surface& surface, const std::vector<FaceDistortion>& of_triangle,
                               std::pair<Eigen::Index, Eigen::Index> range) {
  FaceDistortion mean;
  double area = 0;
  for (Eigen::Index t = range.first; t < range.second; ++t) {
    if (!(of_triangle[t].area > 0)) continue;
    const double share = surface.area(t);
    mean.area += share * of_triangle[t].area;
    mean.angle += share * of_triangle[t].angle;
    area += share;
  }
  if (area > 0) mean.area /= area, mean.angle /= area;
  return mean;
}

std::vector<FaceDistortion> distortion_of_faces(const Surface& surface,
                                                const std::vector<FaceDistortion>& of_triangle) {
  const FaceView faces = surface.faces();
  std::vector<FaceDistortion> result;
  Eigen::Index t = 0;
  for (int f = 0; f < faces.count(); ++f) {
    const Eigen::Index end = t + faces.degree(f) - 2;
    result.push_back(end == t + 1 ? of_triangle[t] : mean_distortion(surface, of_triangle, {t, end}));
    t = end;
  }
  return result;
}

// From blue (shrunk) through white to red (stretched), with a factor of 8 at the ends: the diverging map of
// K. Moreland (2009), linear between its ends.
Rgb distortion_colour(double log_area) {
  const double t = std::clamp(log_area / 3, -1.0, 1.0);
  const auto between = [&](double end) {
    return static_cast<std::uint8_t>(std::lround(245 + (end - 245) * std::abs(t)));
  };
  return t < 0 ? Rgb{between(59), between(76), between(192)} : Rgb{between(180), between(4), between(38)};
}

PlyProperty floats(const std::string& name, std::vector<double> values) {
  return {name, PlyType::float32, false, PlyType::uint8, std::move(values), {}};
}

PlyProperty doubles(const std::string& name, const Eigen::VectorXd& values) {
  return {name, PlyType::float64, false, PlyType::uint8, {values.begin(), values.end()}, {}};
}

PlyProperty property_of(const FaceView& faces) {
  PlyProperty property = {"vertex_indices", PlyType::int32, true, corner_count_type(faces), {}, {0}};
  for (int f = 0; f < faces.count(); ++f) {
    property.values.insert(property.values.end(), faces[f].begin(), faces[f].end());
    property.list_start.push_back(property.values.size());
  }
  return property;
}

}  // namespace

std::vector<double> face_quality(const ExportedModel& model) {
  std::vector<double> quality;
  for (const FaceDistortion& face : model.of_face)
    quality.push_back(face.area > 0 ? std::log2(face.area) : 0.0);
  return quality;
}

std::vector<double> vertex_quality(const ExportedModel& model) {
  const std::vector<double> of_face = face_quality(model);
  const FaceView faces = model.surface.faces();
  std::vector<double> sum(model.surface.vertex_count(), 0.0), count(sum);
  for (int f = 0; f < faces.count(); ++f) {
    for (const int v : faces[f]) {
      sum[v] += of_face[f];
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (count[v] > 0) sum[v] /= count[v];
  return sum;
}

std::string obj_text(const ExportedModel& model) {
  std::string text = "# texture coordinates: orbitutte embedding " + model.embedding.target.signature + "\n";
  append_textured_obj(model.surface, {model.texture.uv, texture_rows(model)}, text);
  return text;
}

std::string glb_bytes(const ExportedModel& model) {
  const std::vector<int> rows = texture_rows(model), source = source_of_texture_vertex(model, rows);
  check_glb_size(44 * source.size() + 12 * static_cast<std::size_t>(model.surface.triangles.rows()),
                 "the model");
  const Points normals_of_input = vertex_normals(model.surface.V, model.surface.triangles);
  const std::vector<double> quality = vertex_quality(model);
  const auto count = static_cast<Eigen::Index>(source.size());
  Points positions(count, 3), normals(count, 3);
  std::vector<Rgb> colours;
  for (Eigen::Index v = 0; v < count; ++v) {
    positions.row(v) = model.surface.V.row(source[v]);
    normals.row(v) = normals_of_input.row(source[v]);
    colours.push_back(distortion_colour(quality[source[v]]));
  }
  std::vector<std::uint32_t> indices;
  indices.reserve(static_cast<std::size_t>(model.surface.triangles.size()));
  for (int h = 0; h < static_cast<int>(model.surface.triangles.size()); ++h)
    indices.push_back(static_cast<std::uint32_t>(rows[corner_of(model.surface, h)]));
  GltfModel gltf;
  const std::map<std::string, int> attributes = {
      {"POSITION", gltf.add_positions(positions)},
      {"NORMAL", gltf.add_vectors(normals)},
      {"TEXCOORD_0", gltf.add_texture_coordinates(model.texture.uv)},
      {"COLOR_0", gltf.add_colours(colours)}};
  const int triangles_of_model = gltf.add_triangles(indices);
  gltf.add_primitive(attributes, triangles_of_model,
                     gltf.add_material("distortion", {255, 255, 255}, GltfModel::Sides::both));
  return gltf.bytes();
}

std::string ply_bytes(const ExportedModel& model) {
  const Points& V = model.surface.V;
  const FaceView faces = model.surface.faces();
  const PlyElement vertex = {"vertex",
                             static_cast<std::size_t>(V.rows()),
                             {doubles("x", V.col(0)), doubles("y", V.col(1)), doubles("z", V.col(2)),
                              floats("quality", vertex_quality(model))}};
  const PlyElement face = {"face",
                           static_cast<std::size_t>(faces.count()),
                           {property_of(faces), floats("quality", face_quality(model))}};
  return serialize_ply({{"quality: log2 of the area distortion of the orbitutte embedding " +
                         model.embedding.target.signature},
                        {vertex, face}});
}

ExportedModel exported_model(Surface surface, const Embedding& embedding, TextureChart chart) {
  require_cut_from(surface, embedding);
  ExportedModel model = {std::move(surface), embedding, texture_coordinates(embedding, chart), {}};
  model.embedding.triangles = cut_triangles(model.surface, embedding);
  model.of_face = distortion_of_faces(model.surface, measure_triangles(model.surface, model.embedding));
  return model;
}

namespace {

struct ModelFormat {
  const char* ending;
  std::string (*bytes)(const ExportedModel&);
};

constexpr ModelFormat model_formats[] = {
    {".obj", obj_text}, {".glb", glb_bytes}, {".ply", ply_bytes}, {".vtp", vtp_text}};

}  // namespace

std::vector<std::string> model_endings() {
  std::vector<std::string> endings;
  for (const ModelFormat& format : model_formats) endings.emplace_back(format.ending);
  return endings;
}

void write_model(const std::string& path, const ExportedModel& model) {
  const std::string plain = without_gz(path), ending = ending_of(plain);
  for (const ModelFormat& format : model_formats) {
    if (ending != format.ending) continue;
    const std::string bytes = format.bytes(model);
    return write_file(path, plain == path ? bytes : compress_to_gzip(bytes));
  }
  throw ArgumentError(fmt::format("{}: a model is written as {}", path, listed_choices(model_endings())));
}

}  // namespace orbitutte
