// SPDX-License-Identifier: MIT
#include "orbitutte/output/export.h"

#include <fmt/compile.h>
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cctype>
#include <cmath>
#include <filesystem>
#include <iterator>

#include "orbitutte/mesh/file.h"
#include "orbitutte/mesh/ply.h"
#include "orbitutte/output/export_files.h"
#include "orbitutte/output/file_ending.h"
#include "orbitutte/output/gltf_model.h"

namespace orbitutte {
namespace {

bool is_cut_from(const Mesh& mesh, const Embedding& embedding) {
  const auto vertices = static_cast<Eigen::Index>(embedding.source_vertex.size());
  if (embedding.positions.rows() != vertices || vertices < mesh.V.rows()) return false;
  if (embedding.faces.rows() != mesh.F.rows()) return false;
  for (Eigen::Index f = 0; f < mesh.F.rows(); ++f) {
    const auto v = embedding.faces.row(f);
    if (v.minCoeff() < 0 || v.maxCoeff() >= vertices) return false;
    std::array<int, 3> sources = {embedding.source_vertex[v[0]], embedding.source_vertex[v[1]],
                                  embedding.source_vertex[v[2]]};
    std::array<int, 3> given = {mesh.F(f, 0), mesh.F(f, 1), mesh.F(f, 2)};
    std::sort(sources.begin(), sources.end());
    std::sort(given.begin(), given.end());
    if (sources != given) return false;
  }
  return true;
}

// The corner of the embedding's face f at the input's k-th corner: another one only where the face was turned
// over.
int corner_of(const ExportedModel& model, Eigen::Index f, int k) {
  for (int l = 0; l < 3; ++l)
    if (model.embedding.source_vertex[model.embedding.faces(f, l)] == model.mesh.F(f, k))
      return static_cast<int>(3 * f) + l;
  return static_cast<int>(3 * f) + k;
}

// The mean of its faces' normals, weighted by their areas, of every input vertex.
Points vertex_normals(const Mesh& mesh) {
  Points normals = Points::Zero(mesh.V.rows(), 3);
  for (const auto& v : mesh.F.rowwise()) {
    const Vector3 a = mesh.V.row(v[0]), b = mesh.V.row(v[1]), c = mesh.V.row(v[2]);
    const Vector3 normal = (b - a).cross(c - a);
    for (int k = 0; k < 3; ++k) normals.row(v[k]) += normal.transpose();
  }
  for (Eigen::Index v = 0; v < normals.rows(); ++v) {
    const double length = normals.row(v).norm();
    normals.row(v) = length > 0 ? Eigen::RowVector3d(normals.row(v) / length) : Eigen::RowVector3d(0, 0, 1);
  }
  return normals;
}

// The source vertex of every row of texture coordinates.
std::vector<int> source_of_texture_vertex(const ExportedModel& model) {
  std::vector<int> source(model.texture.uv.rows(), 0);
  for (std::size_t v = 0; v < model.embedding.source_vertex.size(); ++v)
    source[v] = model.embedding.source_vertex[v];
  for (Eigen::Index f = 0; f < model.mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      source[model.texture.of_corner[3 * f + k]] = model.embedding.source_vertex[model.embedding.faces(f, k)];
  return source;
}

// From blue (shrunk) by white to red (stretched), a factor of 8 at the ends: the diverging map of K. Moreland
// (2009) in straight lines.
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

PlyProperty triangles(const Faces& F) {
  PlyProperty property = {"vertex_indices", PlyType::int32, true, PlyType::uint8, {}, {}};
  property.values.assign(F.data(), F.data() + F.size());
  for (Eigen::Index f = 0; f <= F.rows(); ++f) property.list_start.push_back(3 * static_cast<std::size_t>(f));
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
  std::vector<double> sum(model.mesh.V.rows(), 0.0), count(sum);
  for (Eigen::Index f = 0; f < model.mesh.F.rows(); ++f) {
    for (const int v : model.mesh.F.row(f)) {
      sum[v] += of_face[f];
      ++count[v];
    }
  }
  for (std::size_t v = 0; v < sum.size(); ++v)
    if (count[v] > 0) sum[v] /= count[v];
  return sum;
}

std::string obj_text(const ExportedModel& model) {
  std::string text = "# texture coordinates: orbitutte embedding " + model.embedding.signature + "\n";
  const auto out = std::back_inserter(text);
  // The shortest decimals that read back as the same doubles.
  for (const auto& p : model.mesh.V.rowwise())
    fmt::format_to(out, FMT_COMPILE("v {} {} {}\n"), p[0], p[1], p[2]);
  for (const auto& p : model.texture.uv.rowwise()) fmt::format_to(out, FMT_COMPILE("vt {} {}\n"), p[0], p[1]);
  for (Eigen::Index f = 0; f < model.mesh.F.rows(); ++f) {
    text += "f";
    for (int k = 0; k < 3; ++k)
      fmt::format_to(out, FMT_COMPILE(" {}/{}"), model.mesh.F(f, k) + 1LL,
                     model.texture.of_corner[corner_of(model, f, k)] + 1LL);
    text += "\n";
  }
  return text;
}

std::string glb_bytes(const ExportedModel& model) {
  const std::vector<int> source = source_of_texture_vertex(model);
  check_glb_size(44 * source.size() + 12 * static_cast<std::size_t>(model.mesh.F.rows()), "the model");
  const Points normals_of_input = vertex_normals(model.mesh);
  const std::vector<double> quality = vertex_quality(model);
  const auto count = static_cast<Eigen::Index>(source.size());
  Points positions(count, 3), normals(count, 3);
  std::vector<Rgb> colours;
  for (Eigen::Index v = 0; v < count; ++v) {
    positions.row(v) = model.mesh.V.row(source[v]);
    normals.row(v) = normals_of_input.row(source[v]);
    colours.push_back(distortion_colour(quality[source[v]]));
  }
  std::vector<std::uint32_t> indices;
  for (Eigen::Index f = 0; f < model.mesh.F.rows(); ++f)
    for (int k = 0; k < 3; ++k)
      indices.push_back(static_cast<std::uint32_t>(model.texture.of_corner[corner_of(model, f, k)]));
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
  const Mesh& mesh = model.mesh;
  const PlyElement vertex = {"vertex",
                             static_cast<std::size_t>(mesh.V.rows()),
                             {doubles("x", mesh.V.col(0)), doubles("y", mesh.V.col(1)),
                              doubles("z", mesh.V.col(2)), floats("quality", vertex_quality(model))}};
  const PlyElement face = {"face",
                           static_cast<std::size_t>(mesh.F.rows()),
                           {triangles(mesh.F), floats("quality", face_quality(model))}};
  return serialize_ply(
      {{"quality: log2 of the area distortion of the orbitutte embedding " + model.embedding.signature},
       {vertex, face}});
}

ExportedModel exported_model(const Mesh& mesh, const Embedding& embedding, TextureChart chart) {
  if (!is_cut_from(mesh, embedding)) throw MeshError("the embedding is none of this mesh");
  return {mesh, embedding, texture_coordinates(embedding, chart), measure_faces(mesh, embedding)};
}

void write_model(const std::string& path, const ExportedModel& model) {
  const std::string ending = lower_case_ending(path);
  if (ending == ".obj") return write_file(path, obj_text(model));
  if (ending == ".glb") return write_file(path, glb_bytes(model));
  if (ending == ".ply") return write_file(path, ply_bytes(model));
  if (ending == ".vtp") return write_file(path, vtp_text(model));
  throw ArgumentError(fmt::format("{}: a model is written as .obj, .glb, .ply or .vtp", path));
}

}  // namespace orbitutte
