// SPDX-License-Identifier: MIT
// Values at vertices in GIfTI files (.shape.gii, .func.gii, .label.gii).
#include <fmt/format.h>

#include "orbitutte/io/gifti.h"
#include "orbitutte/io/text_scanner.h"
#include "orbitutte/io/vertex_data_formats.h"
#include "orbitutte/types.h"

namespace orbitutte {
namespace {

bool is_surface_array(const GiftiArray& array) {
  return array.intent == gifti_points || array.intent == gifti_triangles;
}

// The columns of all arrays side by side.
Eigen::Index total_columns(const std::vector<const GiftiArray*>& arrays) {
  Eigen::Index columns = 0;
  for (const GiftiArray* array : arrays) columns += array->columns;
  return columns;
}

// The arrays that are no surface. Throws MeshError unless there is one, and all have the same rows.
std::vector<const GiftiArray*> data_arrays(const GiftiFile& file) {
  std::vector<const GiftiArray*> arrays;
  arrays.reserve(file.arrays.size());
  for (std::size_t k = 0; k < file.arrays.size(); ++k) {
    const GiftiArray& array = file.arrays[k];
    if (is_surface_array(array)) continue;
    if (array.intent == "NIFTI_INTENT_NODE_INDEX")
      throw MeshError(fmt::format(
          "DataArray {} lists vertices (NIFTI_INTENT_NODE_INDEX), so that the values are not those of "
          "all vertices; export the file with all of them",
          k));
    if (!arrays.empty() && array.rows != arrays.front()->rows)
      throw MeshError(fmt::format(
          "DataArray {} ({}) has {} rows, but those before it have {}; take one file for each surface", k,
          shown(array.intent), array.rows, arrays.front()->rows));
    arrays.push_back(&array);
  }
  if (arrays.empty())
    throw MeshError(
        "the file has no DataArray but points and triangles; take a file of values (.shape.gii, .func.gii or "
        ".label.gii)");
  return arrays;
}

// Of an array with several columns, which have one name together.
std::string column_name(const GiftiArray& array, int column) {
  if (array.columns == 1 || array.name.empty()) return array.name;
  return fmt::format("{} {}", array.name, column);
}

GiftiArray array_of_map(const VertexData& data, Eigen::Index map, std::string_view intent) {
  GiftiArray array;
  array.intent = intent;
  if (!data.names.empty()) array.name = data.names[static_cast<std::size_t>(map)];
  array.rows = static_cast<int>(data.values.rows());
  array.values.assign(data.values.col(map).begin(), data.values.col(map).end());
  return array;
}

GiftiFile file_of_maps(const VertexData& data, std::string_view intent) {
  GiftiFile file;
  file.arrays.reserve(static_cast<std::size_t>(data.values.cols()));
  for (Eigen::Index map = 0; map < data.values.cols(); ++map)
    file.arrays.push_back(array_of_map(data, map, intent));
  return file;
}

}  // namespace

VertexData read_gifti_data(std::string_view bytes) {
  const GiftiFile file = read_gifti_file(bytes);
  const std::vector<const GiftiArray*> arrays = data_arrays(file);
  VertexData data;
  data.values.resize(arrays.front()->rows, total_columns(arrays));
  std::vector<std::string> names;
  names.reserve(static_cast<std::size_t>(data.values.cols()));
  for (const GiftiArray* array : arrays) {
    const auto rows = Eigen::Map<const Eigen::Matrix<double, -1, -1, Eigen::RowMajor>>(
        array->values.data(), array->rows, array->columns);
    data.values.middleCols(static_cast<Eigen::Index>(names.size()), array->columns) = rows;
    for (int column = 0; column < array->columns; ++column) names.push_back(column_name(*array, column));
  }
  set_map_names(data, std::move(names));
  if (arrays.front()->intent == gifti_labels) data.labels = file.labels;
  return data;
}

std::string write_shape_gifti(const VertexData& data) {
  return write_gifti_file(file_of_maps(data, gifti_shape));
}

std::string write_func_gifti(const VertexData& data) {
  return write_gifti_file(file_of_maps(data, gifti_other));
}

std::string write_label_gifti(const VertexData& data) {
  for (Eigen::Index map = 0; map < data.values.cols(); ++map)
    for (Eigen::Index vertex = 0; vertex < data.values.rows(); ++vertex) label_key(data, vertex, map);
  GiftiFile file = file_of_maps(data, gifti_labels);
  file.labels = data.labels;
  return write_gifti_file(file);
}

}  // namespace orbitutte
