// SPDX-License-Identifier: MIT
#include "grid_values.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "command_arguments.h"
#include "orbitutte/errors.h"
#include "orbitutte/io/compression.h"
#include "orbitutte/io/file.h"
#include "orbitutte/io/numpy_array.h"
#include "orbitutte/io/png.h"
#include "standard_streams.h"

namespace orbitutte::cli {
namespace {

using ByRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

NumpyArray values_in(std::string_view archive) {
  for (auto& [name, array] : parse_numpy_archive(archive))
    if (name == "values") return std::move(array);
  throw MeshError("there is no array 'values' in it");
}

// Is it an .npy, plain or compressed?
bool is_array_file(const std::string& path) { return ending_of(without_gz(path)) == ".npy"; }

// The array of an .npy, or `values` of an .npz; nothing for other files.
std::optional<NumpyArray> read_array(const std::string& path) {
  if (ending_of(path) == ".npz") return parse_file(path, values_in);
  if (!is_array_file(path)) return std::nullopt;
  return parse_file(path, [&](std::string_view bytes) {
    return is_compressed(path) ? parse_numpy_array(decompress(bytes)) : parse_numpy_array(bytes);
  });
}

[[noreturn]] void refuse_count(const std::string& path, std::size_t count, int rows, const char* what) {
  throw MeshError(
      fmt::format("{} has {} values, but there are {} {}; it needs a row for each", path, count, rows, what));
}

// One row for each vertex or point, whatever the dimensions.
GridValues values_of(const NumpyArray& array, int rows, const std::string& path, const char* what) {
  const std::size_t count = array.values.size();
  if (rows == 0 || count == 0 || count % static_cast<std::size_t>(rows) != 0)
    refuse_count(path, count, rows, what);
  GridValues result;
  result.values =
      Eigen::Map<const ByRows>(array.values.data(), rows, static_cast<Eigen::Index>(count) / rows);
  result.is_label = array.is_whole;
  return result;
}

GridValues read_data(const std::string& path, int rows, const char* what) {
  GridValues result;
  static_cast<VertexData&>(result) = read_vertex_data(path);
  // A table of labels may be empty.
  result.is_label = !result.labels.empty() || vertex_data_format(path) == VertexDataFormat::label_gifti;
  if (result.values.rows() != rows)
    refuse_count(path, static_cast<std::size_t>(result.values.rows()), rows, what);
  return result;
}

NumpyArray numpy(const Points& points) {
  return {{static_cast<int>(points.rows()), 3}, {points.data(), points.data() + points.size()}, false};
}

NumpyArray numpy(const std::vector<int>& numbers) {
  return {{static_cast<int>(numbers.size())}, {numbers.begin(), numbers.end()}, true};
}

NumpyArray numpy(const Eigen::VectorXd& numbers) {
  return {{static_cast<int>(numbers.size())}, {numbers.data(), numbers.data() + numbers.size()}, false};
}

// Values in a shape, with a last dimension for several maps.
NumpyArray numpy(const GridValues& values, std::vector<int> shape) {
  const ByRows rows = values.values;
  if (rows.cols() != 1) shape.push_back(static_cast<int>(rows.cols()));
  return {std::move(shape), {rows.data(), rows.data() + rows.size()}, values.is_label && rows.allFinite()};
}

void add_table(const SparseTable& table, NumpyArchive& archive) {
  if (table.rows() == 0) return;
  archive.emplace_back("indptr", numpy(table.start));
  archive.emplace_back("indices", numpy(table.index));
  archive.emplace_back("weights", NumpyArray{{static_cast<int>(table.weight.size())}, table.weight, false});
}

// The values of an image with its margin.
struct Padded {
  GridValues values;
  std::vector<int> shape;
};

Padded padded(const ResampledOutput& output) {
  Padded result = {output.values, output.grid.shape};
  if (!output.grid.is_image()) result.shape = {output.grid.count()};
  if (output.margin == 0) return result;
  const std::vector<int> points = padded_points(output.grid, output.margin);
  result.shape = padded_shape(output.grid, output.margin);
  result.values.values.resize(static_cast<Eigen::Index>(points.size()), output.values.values.cols());
  for (std::size_t k = 0; k < points.size(); ++k)
    result.values.values.row(static_cast<Eigen::Index>(k)) = output.values.values.row(points[k]);
  return result;
}

std::uint16_t to_sixteen_bits(double share) {
  return static_cast<std::uint16_t>(std::lround(std::clamp(share, 0.0, 1.0) * 65535));
}

// Labels as their colours, or their numbers.
void paint_labels(const GridValues& values, PngPixels& pixels) {
  pixels.channels = values.labels.empty() ? 1 : 3;
  for (const double value : values.values.reshaped()) {
    if (values.labels.empty()) {
      if (!(value >= 0 && value <= 255))
        throw ArgumentError(
            fmt::format("a PNG of labels holds 0 to 255, and there is the label {}; write .npy", value));
      pixels.values.push_back(static_cast<std::uint16_t>(257 * static_cast<int>(value)));
      continue;
    }
    const auto label = std::find_if(values.labels.begin(), values.labels.end(),
                                    [&](const ValueLabel& known) { return known.key == value; });
    for (int c = 0; c < 3; ++c)
      pixels.values.push_back(label == values.labels.end() ? 0 : to_sixteen_bits(label->colour[c]));
  }
}

// One map as grey, black where it is least; three as red, green and blue, 0 .. 1 or 0 .. 255.
void paint_numbers(const std::string& path, const GridValues& values, PngPixels& pixels) {
  pixels.channels = static_cast<int>(values.values.cols());
  double low = 0, high = 0;
  bool is_first = true;
  for (const double value : values.values.reshaped()) {
    if (!std::isfinite(value)) continue;
    low = is_first ? value : std::min(low, value);
    high = is_first ? value : std::max(high, value);
    is_first = false;
  }
  if (pixels.channels == 1) {
    tell("{}: black is {:.9g}, white is {:.9g}\n", path, low, high);
  } else {
    low = 0;
    high = high > 1 ? 255 : 1;
  }
  const ByRows rows = values.values;
  for (const double value : rows.reshaped<Eigen::RowMajor>())
    pixels.values.push_back(std::isfinite(value) && high > low ? to_sixteen_bits((value - low) / (high - low))
                                                               : 0);
}

std::string png_of(const std::string& path, const Padded& image) {
  if (image.values.values.cols() != 1 && image.values.values.cols() != 3)
    throw ArgumentError(
        fmt::format("a PNG holds one map or three (red, green, blue), and there are {}; write .npy",
                    image.values.values.cols()));
  PngPixels pixels;
  pixels.width = image.shape.back();
  pixels.height = static_cast<int>(image.values.values.rows()) / pixels.width;
  pixels.values.reserve(3 * static_cast<std::size_t>(image.values.values.rows()));
  const bool is_label = image.values.is_label && image.values.values.cols() == 1;
  if (is_label) {
    paint_labels(image.values, pixels);
  } else {
    paint_numbers(path, image.values, pixels);
  }
  return serialize_png(pixels, is_label || pixels.channels == 3 ? PngDepth::eight : PngDepth::sixteen);
}

// Writes an .npy or, compressed, an .npy.gz; false for other files.
bool write_array(const std::string& path, const GridValues& values, const std::vector<int>& shape) {
  if (!is_array_file(path)) return false;
  write_compressed_as_named(path, serialize_numpy_array(numpy(values, shape)));
  return true;
}

void write_archive(const std::string& path, const NumpyArchive& archive) {
  write_file(path, serialize_numpy_archive(archive));
}

GridValues read_png(const std::string& path, const Grid& grid) {
  const PngPixels pixels = parse_file(path, parse_png);
  if (!grid.is_image() || pixels.width != grid.shape.back() ||
      static_cast<long long>(pixels.width) * pixels.height != grid.count())
    throw ArgumentError(fmt::format("{} has {} x {} pixels, which is not the shape of the grid", path,
                                    pixels.width, pixels.height));
  NumpyArray array;
  array.values.reserve(pixels.values.size());
  for (const std::uint16_t value : pixels.values) array.values.push_back(value / 65535.0);
  return values_of(array, grid.count(), path, "points of the grid");
}

}  // namespace

GridValues read_surface_values(const std::string& path, int vertices) {
  constexpr const char* what = "vertices";
  if (const std::optional<NumpyArray> array = read_array(path))
    return values_of(*array, vertices, path, what);
  return read_data(path, vertices, what);
}

GridValues read_grid_values(const std::string& path, const Grid& grid) {
  constexpr const char* what = "points of the grid";
  if (const std::optional<NumpyArray> array = read_array(path))
    return values_of(*array, grid.count(), path, what);
  return ending_of(path) == ".png" ? read_png(path, grid) : read_data(path, grid.count(), what);
}

void write_grid_values(const std::string& path, const ResampledOutput& output) {
  const bool is_archive = ending_of(path) == ".npz", has_values = output.values.values.size() > 0;
  const Padded image = has_values ? padded(output) : Padded();
  if (!is_archive) {
    if (ending_of(path) == ".png") return write_file(path, png_of(path, image));
    if (write_array(path, image.values, image.shape)) return;
    return write_as_asked(path, image.values);
  }
  const Grid& grid = output.grid;
  NumpyArchive archive;
  archive.reserve(10);
  archive.emplace_back("points", numpy(grid.points));
  archive.emplace_back("areas", numpy(grid.areas));
  if (output.cell_areas.size() > 0) archive.emplace_back("surface_areas", numpy(output.cell_areas));
  if (grid.triangles.rows() > 0) {
    const int* const corners = grid.triangles.data();
    archive.emplace_back("triangles", NumpyArray{{static_cast<int>(grid.triangles.rows()), 3},
                                                 {corners, corners + grid.triangles.size()},
                                                 true});
  }
  if (grid.is_image()) {
    NumpyArray padding = numpy(padded_points(grid, output.margin));
    padding.shape = padded_shape(grid, output.margin);
    archive.emplace_back("image", std::move(padding));
  }
  add_table(output.table, archive);
  if (has_values) archive.emplace_back("values", numpy(image.values, image.shape));
  write_archive(path, archive);
}

void write_surface_values(const std::string& path, const ResampledOutput& output) {
  if (ending_of(path) == ".png")
    throw ArgumentError(
        fmt::format("'{}' would be an image, but --back makes values of vertices; write .npy, .txt "
                    "or .shape.gii",
                    path));
  const std::vector<int> shape = {static_cast<int>(output.values.values.rows())};
  if (write_array(path, output.values, shape)) return;
  if (ending_of(path) != ".npz") return write_as_asked(path, output.values);
  NumpyArchive archive;
  archive.reserve(4);
  add_table(output.table, archive);
  if (output.values.values.size() > 0) archive.emplace_back("values", numpy(output.values, shape));
  write_archive(path, archive);
}

}  // namespace orbitutte::cli
