// SPDX-License-Identifier: MIT
// VTK's XML format for polygonal data (VTK file formats, "XML file formats"). Arrays are base64, preceded by
// their length.
#include <fmt/format.h>

#include <cstdint>
#include <string_view>

#include "orbitutte/export/export_files.h"
#include "orbitutte/export/html_text.h"
#include "orbitutte/io/base64.h"
#include "orbitutte/io/bytes.h"

namespace orbitutte {
namespace {

template <typename Number, typename Values>
std::string data_array(std::string_view type, std::string_view name, int components, const Values& values) {
  std::string bytes;
  for (const auto value : values) append_little_endian(bytes, static_cast<Number>(value));
  std::string framed;
  append_little_endian(framed, static_cast<std::uint64_t>(bytes.size()));
  framed += bytes;
  return fmt::format(
      "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"binary\">{}</DataArray>\n", type,
      name, components, base64(framed));
}

template <typename Values>
std::string float_array(std::string_view name, int components, const Values& values) {
  return data_array<double>("Float64", name, components, values);
}

template <typename Values>
std::string int_array(std::string_view name, const Values& values) {
  return data_array<std::int32_t>("Int32", name, 1, values);
}

std::string polygons(const FaceView& faces) {
  std::vector<int> corners, ends;
  for (int f = 0; f < faces.count(); ++f) {
    corners.insert(corners.end(), faces[f].begin(), faces[f].end());
    ends.push_back(static_cast<int>(corners.size()));
  }
  return "<Polys>\n" + int_array("connectivity", corners) + int_array("offsets", ends) + "</Polys>\n";
}

std::vector<double> flattened(const Points& points) { return {points.data(), points.data() + points.size()}; }

// The position in space of every cut vertex.
std::vector<double> source_positions(const ExportedModel& model) {
  std::vector<double> result;
  for (const int v : model.embedding.source_vertex)
    for (int k = 0; k < 3; ++k) result.push_back(model.surface.V(v, k));
  return result;
}

// The pairs of the cut vertices only, since a vertex of VTK has one pair.
std::vector<double> texture_pairs(const ExportedModel& model) {
  std::vector<double> result;
  for (std::size_t v = 0; v < model.embedding.source_vertex.size(); ++v)
    for (int k = 0; k < 2; ++k) result.push_back(model.texture.uv(static_cast<Eigen::Index>(v), k));
  return result;
}

std::vector<double> angle_distortion(const ExportedModel& model) {
  std::vector<double> result;
  for (const FaceDistortion& face : model.of_face) result.push_back(face.angle);
  return result;
}

}  // namespace

std::string vtp_text(const ExportedModel& model) {
  const std::size_t points = model.embedding.source_vertex.size();
  return fmt::format(
             "<?xml version=\"1.0\"?>\n"
             "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" "
             "header_type=\"UInt64\">\n"
             "<PolyData>\n<Piece NumberOfPoints=\"{}\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
             "NumberOfStrips=\"0\" "
             "NumberOfPolys=\"{}\">\n",
             points, model.surface.faces().count()) +
         "<PointData TCoords=\"texture\">\n" +
         float_array("sphere", 3, flattened(model.embedding.positions)) +
         float_array("texture", 2, texture_pairs(model)) +
         int_array("source_vertex", model.embedding.source_vertex) +
         "</PointData>\n<CellData Scalars=\"log2_area\">\n" +
         float_array("log2_area", 1, face_quality(model)) + float_array("angle", 1, angle_distortion(model)) +
         "</CellData>\n<Points>\n" + float_array("Points", 3, source_positions(model)) + "</Points>\n" +
         polygons(model.embedding.faces()) + "</Piece>\n</PolyData>\n</VTKFile>\n";
}

}  // namespace orbitutte
